"""Runs a cocotb bench: generated VHDL in GHDL, the stimulus and the checks in Python."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from cocotb_tools.check_results import get_results
from cocotb_tools.runner import get_runner

STANDARD = "--std=93c"
QUICK = "-O0"
"""A bench is short: compiling it well takes longer than running it."""


def run_bench(
    folder: Path,
    toplevel: str,
    bench: str,
    *,
    build: Path,
    parameters: Mapping[str, object] | None = None,
    more_sources: Sequence[Path] = (),
    environment: Mapping[str, str] | None = None,
    ieee_asserts: str = "disable-at-0",
) -> int:
    """Run ``benches/BENCH.py`` on an entity of a generated folder.

    Parameters
    ----------
    build
        Where GHDL works, and what the simulation writes goes.
    parameters
        Generics of the entity.
    more_sources
        VHDL beside the generated, such as a wrapper with plain ports.
    environment
        What the bench reads from `os.environ`.
    ieee_asserts
        Which warnings of unknown values GHDL leaves out; a pipeline computes with them until the
        first sample comes.

    Returns
    -------
    int
        The number of tests that ran; a test that failed is an assertion here.
    """
    runner = get_runner("ghdl")
    runner.build(
        sources=[*sorted(folder.glob("*.vhd")), *more_sources],
        hdl_toplevel=toplevel,
        build_dir=build,
        build_args=[STANDARD, QUICK],
    )
    results = runner.test(
        hdl_toplevel=toplevel,
        hdl_toplevel_lang="vhdl",
        test_module=bench,
        test_args=[STANDARD, QUICK],
        plusargs=[f"--ieee-asserts={ieee_asserts}"],
        parameters=parameters or {},
        build_dir=build,
        test_dir=build,
        extra_env=environment or {},
    )
    tests, failed = get_results(results)
    assert tests > 0
    assert failed == 0, f"{failed} of {tests} tests of {bench} failed"
    return int(tests)
