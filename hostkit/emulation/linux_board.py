"""The Linux target: the program as it is, on faked devices of the kernel.

A library that is loaded before the C library answers its calls for an I2C bus and a gpio line, and
gives it a clock: in a run time passes as fast as the program can, served it is the wall clock's.
"""

import dataclasses
import subprocess
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
from hostkit.errors import BuildError, EmulationError

PROGRAM = "firmware"
SOURCES = Path(__file__).parent / "linux"
DEVICES = ("--i2c", "/dev/hk-i2c", "--int", "/dev/hk-gpio:17")
STORE_SLOTS = 2
STORE_SLOT_BYTES = 128
COMPILE = ("gcc", "-std=gnu11", "-D_GNU_SOURCE", "-O2", "-ffp-contract=off", "-shared", "-fPIC")
TIMEOUT_S = 60.0


def build(folder: Path) -> BuildResult:
    """Build a generated folder for this computer.

    Raises
    ------
    BuildError
        If the code does not compile; the message is the compiler's first error.
    ToolMissingError
        If make or gcc is not installed.
    """
    require("gcc", "make")
    make(folder)
    return BuildResult(artifact=folder / PROGRAM)


def run(
    folder: Path,
    stimulus: Stimulus,
    *,
    progress: Progress | None = None,
    devices: tuple[str, ...] = DEVICES,
) -> BoardRun:
    """Play a stimulus to its end, as fast as the host can.

    Parameters
    ----------
    devices
        Options of the program that name its devices.

    Raises
    ------
    BuildError
        If the folder has not been built, or the faked devices do not compile.
    EmulationError
        If the program crashes or hangs, the stimulus loops, or the supply is to fail.
    ToolMissingError
        If gcc is not installed.
    """
    require_end(stimulus)
    if stimulus.power_cut_after is not None:
        raise EmulationError("a slot is renamed into its place here; no byte of it can be spoilt")
    with tempfile.TemporaryDirectory(prefix="hostkit-linux-") as name:
        play = playback(stimulus, Path(name))
        slots = _write_slots(stimulus.store, Path(name))
        command = command_of(folder, play, Path(name), devices)
        heard = collect(command, timeout_s=run_timeout_s(stimulus), progress=progress)
        play.store.write_bytes(_read_slots(slots))
        return board_run(play, heard, progress)


def serve(
    folder: Path, stimulus: Stimulus, send: Send, stop: Stop, receive: Receive = nothing_received
) -> None:
    """Play a stimulus over and over in real time until `stop` says so.

    Raises
    ------
    BuildError
        If the folder has not been built, or the faked devices do not compile.
    EmulationError
        If the program ends by itself.
    ToolMissingError
        If gcc is not installed.
    """
    with tempfile.TemporaryDirectory(prefix="hostkit-linux-") as name:
        play = playback(dataclasses.replace(stimulus, loop=True), Path(name))
        _write_slots(stimulus.store, Path(name))
        stream(command_of(folder, play, Path(name), DEVICES), send, stop, receive)


def command_of(
    folder: Path, play: Playback, work: Path, devices: tuple[str, ...] = DEVICES
) -> list[str]:
    """Return the command that runs a built folder on faked devices.

    Parameters
    ----------
    play
        What the sensor feels.
    work
        Folder for the faked devices and the slots of the store.
    devices
        Options of the program that name its devices.

    Raises
    ------
    BuildError
        If the folder has not been built, or the faked devices do not compile.
    ToolMissingError
        If gcc is not installed.
    """
    program = folder.resolve() / PROGRAM
    if not program.is_file():
        raise BuildError(f"{folder} has not been built yet")
    library = work / "devices.so"
    _compile(folder, library)
    setting = (
        f"LD_PRELOAD={library}",
        f"HK_FAKE_TABLE={play.table}",
        "HK_FAKE_OPTIONS=" + "\n".join(play.options),
    )
    return ["env", *setting, str(program), *devices, "--store", str(work / "slots")]


def _compile(folder: Path, library: Path) -> None:
    require("gcc")
    sensor = sorted(folder.glob("hk_virtual_*.c"))
    files = [*sorted(SOURCES.glob("*.c")), *sensor]
    command = [*COMPILE, f"-I{folder}", "-o", str(library), *map(str, files), "-ldl", "-lm"]
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, timeout=TIMEOUT_S, check=False
        )
    except subprocess.TimeoutExpired as error:
        raise BuildError(f"gcc did not end within {TIMEOUT_S:g} s") from error
    if done.returncode != 0:
        lines = [line for line in done.stderr.splitlines() if "error" in line]
        first = (lines or [done.stderr.strip()])[0]
        raise BuildError(f"the faked devices do not compile: {first}")


def _write_slots(store: bytes, work: Path) -> Path:
    folder = work / "slots"
    folder.mkdir()
    for slot in range(STORE_SLOTS):
        content = store[slot * STORE_SLOT_BYTES : (slot + 1) * STORE_SLOT_BYTES]
        if content:
            (folder / f"slot{slot}").write_bytes(content)
    return folder


def _read_slots(folder: Path) -> bytes:
    erased = b"\xff" * STORE_SLOT_BYTES
    files = [folder / f"slot{slot}" for slot in range(STORE_SLOTS)]
    slots = [file.read_bytes() if file.is_file() else b"" for file in files]
    return b"".join(slot + erased[len(slot) :] for slot in slots)
