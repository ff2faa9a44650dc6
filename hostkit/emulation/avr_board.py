"""The ATmega328P target: the image on the CPU emulator avr8js, the virtual sensor on its bus."""

import dataclasses
import subprocess
import tempfile
from pathlib import Path

from hostkit.emulation.board import BoardRun, BuildResult, Progress, Send, Stimulus, Stop
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
from hostkit.emulation.virtual_sensor import compile_wasm
from hostkit.errors import BuildError

IMAGE = "firmware.hex"
ELF = "firmware.elf"
SCRIPT = Path(__file__).parent / "avr8js" / "board.mjs"
SIZE_TIMEOUT_S = 20.0


def build(folder: Path) -> BuildResult:
    """Build a generated folder and measure the image.

    Raises
    ------
    BuildError
        If the code does not compile; the message is the compiler's first error.
    ToolMissingError
        If make or avr-gcc is not installed.
    """
    require("make", "avr-gcc")
    make(folder)
    flash, ram = _sizes(folder / ELF)
    return BuildResult(artifact=folder / IMAGE, flash_bytes=flash, ram_bytes=ram)


def run(folder: Path, stimulus: Stimulus, *, progress: Progress | None = None) -> BoardRun:
    """Play a stimulus to its end, as fast as the emulator can.

    Raises
    ------
    BuildError
        If the folder has not been built.
    EmulationError
        If the emulator fails or hangs, or the stimulus loops.
    ToolMissingError
        If node, avr8js, clang or its linker is not installed.
    """
    require_end(stimulus)
    with tempfile.TemporaryDirectory(prefix="hostkit-avr-") as name:
        play = playback(stimulus, Path(name))
        command = _command(folder, play, Path(name))
        if progress is not None:
            command.append("--progress")
        heard = collect(command, timeout_s=run_timeout_s(stimulus), progress=progress)
        return board_run(play, heard, progress)


def serve(folder: Path, stimulus: Stimulus, send: Send, stop: Stop) -> None:
    """Play a stimulus over and over in real time until `stop` says so.

    Raises
    ------
    BuildError
        If the folder has not been built.
    EmulationError
        If the emulator ends by itself.
    ToolMissingError
        If node, avr8js, clang or its linker is not installed.
    """
    with tempfile.TemporaryDirectory(prefix="hostkit-avr-") as name:
        play = playback(dataclasses.replace(stimulus, loop=True), Path(name))
        stream(_command(folder, play, Path(name)), send, stop)


def _command(folder: Path, play: Playback, work: Path) -> list[str]:
    require("node", "avr8js")
    image, sensor = folder.resolve() / IMAGE, work / "virtual_mpu6050.wasm"
    if not image.is_file():
        raise BuildError(f"{folder} has not been built yet")
    compile_wasm(folder, sensor)
    files = ("--hex", str(image), "--sensor", str(sensor), "--table", str(play.table))
    return ["node", str(SCRIPT), *files, *play.options]


def _sizes(elf: Path) -> tuple[int, int]:
    """Return flash and static RAM of an image, as avr-size counts them."""
    done = subprocess.run(
        ["avr-size", str(elf)], capture_output=True, text=True, timeout=SIZE_TIMEOUT_S, check=False
    )
    try:
        text, data, bss = (int(word) for word in done.stdout.splitlines()[1].split()[:3])
    except (IndexError, ValueError) as error:
        raise BuildError(f"avr-size cannot measure {elf}: {done.stderr.strip()}") from error
    return text + data, data + bss
