"""Reading what the command line names: recordings with their sanity card, and designs."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from hostkit.design_file import digest, edited_by_hand, load_design
from hostkit.errors import DesignError
from hostkit.mounting import Mounting
from hostkit.recordings import LargeRecording, Recording, check, load, open_large
from hostkit.records import AXES, FilterDesign

Option = Callable[[Callable[..., Any]], Callable[..., Any]]
"""What click.option makes: a decorator of a command."""

RECORDINGS = click.argument(
    "recording_files",
    nargs=-1,
    required=True,
    metavar="REC...",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
)
RECORDINGS_OR_NONE = click.argument(
    "recording_files",
    nargs=-1,
    metavar="[REC...]",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
)
DESIGN = click.argument(
    "design_file",
    metavar="DESIGN",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
)
JSON = click.option("--json", "as_json", is_flag=True, help="Print one JSON document.")
REPORT = click.option(
    "--report",
    "report_file",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="FILE.html",
    help="Also write a report with plots.",
)


def axes_option(text: str) -> Option:
    """Return the option for the angles that a filter gives, with its help."""
    return click.option(
        "--axes", type=click.Choice(tuple(AXES)), default="both", show_default=True, help=text
    )


def parse_mounting(context: click.Context, option: click.Parameter, text: str) -> Mounting:
    """Read a mounting; what is wrong with it is wrong use."""
    try:
        return Mounting.parse(text)
    except DesignError as error:
        raise click.BadParameter(str(error)) from error


def mounting_option(text: str) -> Option:
    """Return the option for how the sensor sits in the body, with its help."""
    return click.option(
        "--mounting",
        default="+x+y+z",
        show_default=True,
        callback=parse_mounting,
        metavar="AXES",
        help=text,
    )


def finite(context: click.Context, option: click.Parameter, value: float | None) -> float | None:
    """Refuse NaN and infinity, which pass click's range check: nothing would exceed them."""
    if value is not None and not math.isfinite(value):
        raise click.BadParameter(f"{value} is not a finite number")
    return value


def say(message: str) -> None:
    """Print progress or a remark, on standard error."""
    click.echo(message, err=True)


def read_recording(path: Path) -> Recording:
    """Load a recording and show its sanity card if anything on it deserves a second look.

    Raises
    ------
    RecordingError
        If the recording has a hard fault.
    """
    recording = load(path)
    card = check(recording)
    if card.findings:
        say(f"{path}: sanity card")
        for line in card.lines():
            say(f"  {line}")
    return recording


def read_for_tuning(path: Path) -> Recording | LargeRecording:
    """Load a recording, or open one that does not fit the memory.

    Raises
    ------
    RecordingError
        If the recording has a hard fault.
    """
    large = open_large(path)
    if large is None:
        return read_recording(path)
    card = check(large.head)
    say(f"{path}: {len(large)} samples are read part by part; sanity card of the first:")
    for line in card.lines():
        say(f"  {line}")
    return large


def read_design(path: Path) -> FilterDesign:
    """Load a design and say so if it was edited since it was written.

    Raises
    ------
    DesignError
        If the file is not a design.
    """
    design = load_design(path)
    if edited_by_hand(path):
        say(f"{path} was edited since it was written; it is now design {digest(design)}")
    return design
