"""The STM32F103 target: the image on the CPU emulator Unicorn, the virtual sensor on its bus.

Unicorn (its engine under GPL-2) is a tool of the tests and of `hostkit emulate` only: an extra that
nothing else needs and that nothing is linked with.
"""

import dataclasses
import re
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from hostkit.emulation.board import (
    BoardRun,
    BuildResult,
    Progress,
    Receive,
    Send,
    SensorFaults,
    Stimulus,
    Stop,
    nothing_received,
)
from hostkit.emulation.image import build_image
from hostkit.emulation.playback import require_end
from hostkit.emulation.virtual_sensor import VirtualSensor, compile_shared
from hostkit.errors import BuildError, EmulationError, ToolMissingError

if TYPE_CHECKING:
    from hostkit.emulation.stm32.machine import Machine

IMAGE = "firmware.bin"
HEADER = "hk_design.h"
BAUD = re.compile(r"^#define HK_LINK_BAUD +(\d+)", re.MULTILINE)
STALL_S = 5.0
SLICE_S = 0.1
UNARMED_SLICE_S = 0.001
FAULT_SLICE_S = 0.01
REALTIME_SLICE_S = 0.005
LAG_LIMIT_S = 1.0
PROGRESS_S = 0.25
COST_UNIT = "instructions"


def build(folder: Path) -> BuildResult:
    """Build a generated folder and measure the image.

    Raises
    ------
    BuildError
        If the code does not compile; the message is the compiler's first error.
    ToolMissingError
        If make or arm-none-eabi-gcc is not installed.
    """
    return build_image(folder, toolchain="arm-none-eabi-", image=IMAGE)


def run(folder: Path, stimulus: Stimulus, *, progress: Progress | None = None) -> BoardRun:
    """Play a stimulus to its end, as fast as the emulator can.

    What an update costs is counted in instructions: the emulator knows no clock cycles.

    Raises
    ------
    BuildError
        If the folder has not been built.
    EmulationError
        If the firmware faults or does what the model does not allow, or the stimulus loops.
    ToolMissingError
        If unicorn or gcc is not installed.
    """
    require_end(stimulus)
    with _machine(folder, stimulus) as machine:
        faults = _Faults(machine, stimulus.faults)
        stalled = _run_to_end(machine, faults, progress)
        if progress is not None:
            progress(machine.sensor.rows_played)
        return _board_run(machine, stalled)


def serve(
    folder: Path, stimulus: Stimulus, send: Send, stop: Stop, receive: Receive = nothing_received
) -> None:
    """Play a stimulus over and over in real time until `stop` says so.

    Raises
    ------
    BuildError
        If the folder has not been built.
    EmulationError
        If the firmware faults or does what the model does not allow.
    ToolMissingError
        If unicorn or gcc is not installed.
    """
    with _machine(folder, dataclasses.replace(stimulus, loop=True)) as machine:
        faults = _Faults(machine, stimulus.faults)
        origin_s = time.monotonic()
        while not stop():
            due_s = time.monotonic() - origin_s
            lag_s = due_s - machine.time.now_s
            if lag_s > LAG_LIMIT_S:
                origin_s += lag_s  # the host was busy: go on from here
            machine.receive(receive())
            machine.run(min(max(lag_s, 0.0), REALTIME_SLICE_S))
            faults.arm()
            if machine.link:
                send(bytes(machine.link))
                machine.link.clear()
            if lag_s < REALTIME_SLICE_S:
                time.sleep(REALTIME_SLICE_S)


@contextmanager
def _machine(folder: Path, stimulus: Stimulus) -> Iterator["Machine"]:
    """Give a board with the image of a folder and the sensor that stands in it."""
    try:
        from hostkit.emulation.stm32.machine import Machine
    except ImportError as error:
        raise ToolMissingError(
            "unicorn is not installed; emulating the stm32f103 needs it: "
            "pip install 'hostkit[stm32]'"
        ) from error
    image = folder / IMAGE
    if not image.is_file():
        raise BuildError(f"{folder} has not been built yet")
    with tempfile.TemporaryDirectory(prefix="hostkit-stm32-") as name:
        library = Path(name) / "virtual_mpu6050.so"
        compile_shared(folder, library)
        sensor = VirtualSensor(library, stimulus)
        yield Machine(
            image.read_bytes(),
            sensor,
            peer_baud=_baud(folder),
            store=stimulus.store,
            power_cut_after=stimulus.power_cut_after,
            received=() if stimulus.loop else stimulus.received,
        )


def _baud(folder: Path) -> int:
    """Return the rate of the link, bit/s, that the generated code is made for."""
    header = folder / HEADER
    found = BAUD.search(header.read_text(encoding="ascii")) if header.is_file() else None
    if found is None:
        raise BuildError(f"{header} has no HK_LINK_BAUD; generate the code again")
    return int(found[1])


class _Faults:
    """What goes wrong on the sensor, armed when its row has come."""

    def __init__(self, machine: "Machine", faults: SensorFaults) -> None:
        self._machine = machine
        self._faults = faults
        self.armed = False
        if faults.who_am_i is not None:
            machine.sensor.set_identity(faults.who_am_i)
        for fault in faults.planned:
            if not machine.sensor.plan(fault):
                raise EmulationError(f"the virtual sensor cannot plan {fault}")
        self.arm()

    @property
    def planned(self) -> bool:
        """Whether the sensor carries out faults by itself."""
        return bool(self._faults.planned)

    def arm(self) -> None:
        """Begin what begins at a row, if it has come."""
        sensor = self._machine.sensor
        if self.armed or sensor.rows_played < self._faults.from_row:
            return
        self.armed = True
        sensor.nack_next(self._faults.nack)
        sensor.hold_sda(self._faults.hold_sda_clocks)
        self._machine.sensor_moved()


def _run_to_end(machine: "Machine", faults: _Faults, progress: Progress | None) -> bool:
    """Run until the machine has finished; return whether it took no more rows instead."""
    armed_slice_s = FAULT_SLICE_S if faults.planned else SLICE_S
    slice_s = armed_slice_s if faults.armed else UNARMED_SLICE_S
    row, since_s, told_s = -1, 0.0, time.monotonic()
    while not machine.finished:
        machine.run(slice_s)
        faults.arm()
        if machine.sensor.rows_played != row:
            row, since_s = machine.sensor.rows_played, machine.time.now_s
        if machine.time.now_s - since_s > STALL_S:
            return True
        if progress is not None and time.monotonic() - told_s >= PROGRESS_S:
            told_s = time.monotonic()
            progress(row)
    return False


def _board_run(machine: "Machine", stalled: bool) -> BoardRun:
    sensor, segments = machine.sensor, machine.segments
    faults = {
        "unread_samples": sensor.unread_samples,
        "stalled": int(stalled),
        "struck": sensor.struck,
        "resets": machine.resets,
    }
    return BoardRun(
        stream=bytes(machine.link),
        cycles_mean=segments.mean,
        cycles_max=segments.largest if segments.count else None,
        cost_unit=COST_UNIT,
        stack_bytes=machine.stack_bytes,
        faults=tuple((name, count) for name, count in faults.items() if count),
        store=bytes(machine.store.data),
    )
