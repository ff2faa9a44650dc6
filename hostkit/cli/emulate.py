"""The subcommand ``emulate``: the generated code run without hardware."""

import contextlib
import math
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import click

from hostkit.cli.chosen import chosen_options
from hostkit.cli.fpga_options import target_options
from hostkit.cli.generate import TARGET
from hostkit.cli.inputs import DESIGN, JSON, read_design, say
from hostkit.cli.output import emit_json
from hostkit.cli.system_options import chosen_system, run_system_of, system_options
from hostkit.emulation.board import BuildResult
from hostkit.emulation.fault import KINDS, parse_fault
from hostkit.emulation.fault_report import FaultReport
from hostkit.emulation.pty_server import serve_pty
from hostkit.emulation.run import EmulationResult, board_of, build, stimulus_of
from hostkit.emulation.run import emulate as run_emulation
from hostkit.errors import VerdictError
from hostkit.recordings import Recording, load
from hostkit.records import FilterDesign
from hostkit.render import Options, generate, target_of, write
from hostkit.targets import TARGETS, Target
from hostkit.tuning.evaluation import require_rate


@click.command("emulate")
@DESIGN
@TARGET
@click.option(
    "--recording",
    "recording_file",
    required=True,
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    metavar="REC",
    help="What the virtual sensor feels.",
)
@click.option(
    "--code",
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    metavar="DIR",
    help="Build and run the code in DIR as it stands, instead of rendering it afresh.",
)
@click.option(
    "--pty",
    is_flag=True,
    help="Serve the board's serial port on a pseudo-terminal, in real time, until Ctrl-C.",
)
@click.option(
    "--fault",
    "fault_texts",
    multiple=True,
    metavar="NAME[=AMOUNT][@TIME]",
    help="Let the sensor fail at TIME of the recording, s; may be given again. Names: "
    + ", ".join(kind.name for kind in KINDS)
    + ".",
)
@system_options
@target_options
@JSON
def emulate(
    design_file: Path,
    target_name: str,
    recording_file: Path,
    code: Path | None,
    pty: bool,
    fault_texts: tuple[str, ...],
    as_json: bool,
) -> None:
    """Run the code of DESIGN on an emulated board or simulator, fed with a recording.

    Every sample that comes back must equal the integer model bit for bit, else the exit code is 3.
    With --pty the path of a pseudo-terminal is printed, to be given to `hostkit monitor`; the
    recording is played over and over. With --fault samples may be lost, but the firmware must
    notice and recover, and every sample that it sends must be right.

    The code is rendered with the options given here; --code has those that it was made with. A
    filter that computes in float is held against the float model instead, within 1e-5 rad.

    For an FPGA the filter alone is simulated, or with --system all from the sensor's bus to the
    serial line, on the first rows of the recording.

    \b
    Example:
      hostkit emulate design.json --target atmega328p --recording sweep.csv
      hostkit emulate design.json --target atmega328p --recording sweep.csv --pty
      hostkit emulate design.json --target host --recording sweep.csv --fault self-reset@2.5
      hostkit emulate design.json --target spartan3adsp --recording sweep.csv --system
    """
    faults = tuple(parse_fault(text) for text in fault_texts)
    if pty and faults:
        raise click.UsageError("--fault needs a run that ends; --pty has no end")
    design, target = read_design(design_file), TARGETS[target_name]
    options = chosen_options(target)
    if code is not None and options is not None:
        raise click.UsageError(
            f"{code} has the options that it was made with; give none, or no DIR"
        )
    recording = load(recording_file)
    require_rate(design.rate_hz, recording)
    if pty and target.kind == "fpga":
        raise click.UsageError(f"{target.name} has no serial port to serve; --pty is for boards")
    system = chosen_system(target)
    with code_folder(design, target, code, options) as folder:
        built = () if system else build(folder, target)
        if pty:
            serve(folder, target, design, recording)
            return
        if system:
            result = run_system_of(folder, target, design, recording, system, faults)
        else:
            shown = show_progress(len(recording))
            result = run_emulation(folder, target, design, recording, shown, faults=faults)
    if as_json:
        emit_json(emulation_document(result, built))
    else:
        _show(result, built)
    if result.fault_report is not None and not result.fault_report.recovered:
        raise VerdictError(f"{target.name} did not recover; it says: {_texts(result.fault_report)}")
    if not result.passed:
        raise VerdictError(
            f"{result.mismatches} of {result.samples} samples differ from the {_model(result)}, "
            f"{result.missing} did not come back"
        )


@contextlib.contextmanager
def code_folder(
    design: FilterDesign, target: Target, code: Path | None, options: Options | None
) -> Iterator[Path]:
    """Give the folder with the code: the user's, or one that is rendered and then removed."""
    if code is not None:
        if target_of(code) is not target:
            raise click.UsageError(f"{code} holds code for {target_of(code).name}")
        yield code
        return
    with tempfile.TemporaryDirectory(prefix="hostkit-") as name:
        write(generate(design, target, options), Path(name))
        yield Path(name)


def serve(folder: Path, target: Target, design: FilterDesign, recording: Recording) -> None:
    """Serve a board on a pseudo-terminal until interrupted; its path is the first line printed."""
    board = board_of(target)
    stimulus = stimulus_of(design, recording, loop=True)

    def announce(path: str) -> None:
        click.echo(path)
        sys.stdout.flush()
        say(f"{target.name} waits there; for example: hostkit monitor DESIGN --port {path}")

    serve_pty(
        lambda send, stop, receive: board.serve(folder, stimulus, send, stop, receive), announce
    )


def show_progress(total: int) -> Callable[[int], None]:
    """Return what shows, on a terminal, how many of `total` samples are done."""

    def show(done: int) -> None:
        if sys.stderr.isatty():
            click.echo(f"\r{done} of {total} samples", nl=done >= total, err=True)

    return show


def emulation_document(
    result: EmulationResult, built: BuildResult | tuple[str, ...]
) -> dict[str, object]:
    """Return the result as the document ``hostkit.emulate/1``."""
    error = result.max_abs_error_rad
    sizes = built if isinstance(built, BuildResult) else None
    in_float = result.tolerance_rad is not None
    return {
        "schema": "hostkit.emulate/1",
        "target": result.target,
        "samples": result.samples,
        "missing": result.missing,
        "mismatches": None if in_float else result.mismatches,
        "beyond_tolerance": result.mismatches if in_float else None,
        "tolerance_rad": result.tolerance_rad,
        "states_told": result.states_told,
        "max_abs_error_deg": None if error is None else math.degrees(error),
        "cycles_per_update": {
            "mean": result.cycles_mean,
            "max": result.cycles_max,
            "unit": result.cost_unit,
        },
        "flash_bytes": sizes and sizes.flash_bytes,
        "ram_bytes": sizes and sizes.ram_bytes,
        "stack_bytes": result.stack_bytes,
        "faults": {**dict(result.faults), **_report_document(result.fault_report)},
    }


def _report_document(report: FaultReport | None) -> dict[str, object]:
    if report is None:
        return {}
    return {
        "injected": list(report.injected),
        "struck": report.struck,
        "reported": {
            "errors": report.errors,
            "restarts": report.restarts,
            "texts": list(report.texts),
        },
        "repeated": report.repeated,
        "spoilt": report.spoilt,
        "recovered": report.recovered,
    }


def _model(result: EmulationResult) -> str:
    if result.tolerance_rad is None:
        return "integer model"
    return f"float model by more than {result.tolerance_rad:g} rad, or in their counts"


def _texts(report: FaultReport) -> str:
    return "; ".join(report.texts) or "nothing"


def _show(result: EmulationResult, built: BuildResult | tuple[str, ...]) -> None:
    error = result.max_abs_error_rad
    shown = "none" if error is None else f"{math.degrees(error):.6f} deg"
    differing = "mismatches"
    if result.tolerance_rad is not None:
        differing = f"beyond {result.tolerance_rad:g} rad (float: no bits are compared)"
    click.echo(
        f"{result.target}: {result.samples} samples, {result.missing} missing, "
        f"{result.mismatches} {differing}; largest difference to the float model {shown}"
    )
    if result.states_told and result.tolerance_rad is None:
        click.echo(f"whole states told and compared: {result.states_told}")
    if result.cycles_mean is not None:
        cost = f"{result.cycles_mean:.1f} mean, {result.cycles_max:.0f} max"
        click.echo(f"{result.cost_unit} per update: {cost}")
    if isinstance(built, BuildResult) and built.flash_bytes is not None:
        click.echo(
            f"image: {built.flash_bytes} bytes of flash, {built.ram_bytes} of static RAM, "
            f"{result.stack_bytes} of stack"
        )
    for name, count in result.faults:
        click.echo(f"fault {name}: {count}")
    report = result.fault_report
    if report is not None:
        click.echo(
            f"injected {', '.join(report.injected)}: {report.errors} errors, "
            f"{report.restarts} restarts, {report.repeated} repeated samples, "
            f"{report.spoilt} with a spoilt axis, "
            f"{'recovered' if report.recovered else 'not recovered'}; "
            f"the firmware says: {_texts(report)}"
        )
