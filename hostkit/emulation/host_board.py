"""The host target: the firmware as a program with the virtual sensor linked in."""

import dataclasses
import tempfile
from pathlib import Path

from hostkit.emulation.board import (
    BoardRun,
    BuildResult,
    Progress,
    Receive,
    Send,
    Stimulus,
    Stop,
    nothing_received,
)
from hostkit.emulation.child import collect, stream
from hostkit.emulation.make import make
from hostkit.emulation.playback import (
    Playback,
    board_run,
    playback,
    require_end,
    run_timeout_s,
)
from hostkit.emulation.tools import require
from hostkit.errors import BuildError

PROGRAM = "firmware"


def build(folder: Path, *, sanitize: bool = False) -> BuildResult:
    """Build a generated folder.

    Parameters
    ----------
    folder
        What `hostkit generate` wrote for the host target.
    sanitize
        Build with address and undefined-behaviour checks.

    Raises
    ------
    BuildError
        If the code does not compile; the message is the compiler's first error.
    ToolMissingError
        If make or gcc is not installed.
    """
    require("gcc", "make")
    make(folder, *(("SANITIZE=1",) if sanitize else ()))
    return BuildResult(artifact=folder / PROGRAM)


def run(folder: Path, stimulus: Stimulus, *, progress: Progress | None = None) -> BoardRun:
    """Play a stimulus to its end, as fast as the host can.

    Raises
    ------
    BuildError
        If the folder has not been built.
    EmulationError
        If the program crashes or hangs, or the stimulus loops.
    """
    require_end(stimulus)
    with tempfile.TemporaryDirectory(prefix="hostkit-host-") as name:
        play = playback(stimulus, Path(name))
        heard = collect(
            _command(folder, play), timeout_s=run_timeout_s(stimulus), progress=progress
        )
        return board_run(play, heard, progress)


def serve(
    folder: Path, stimulus: Stimulus, send: Send, stop: Stop, receive: Receive = nothing_received
) -> None:
    """Play a stimulus over and over in real time until `stop` says so.

    Raises
    ------
    BuildError
        If the folder has not been built.
    EmulationError
        If the program ends by itself.
    """
    with tempfile.TemporaryDirectory(prefix="hostkit-host-") as name:
        play = playback(dataclasses.replace(stimulus, loop=True), Path(name))
        stream(_command(folder, play), send, stop, receive)


def _command(folder: Path, play: Playback) -> list[str]:
    program = folder.resolve() / PROGRAM
    if not program.is_file():
        raise BuildError(f"{folder} has not been built yet")
    return [str(program), str(play.table), *play.options]
