"""Running generated code on a recording, and holding what it says against the models."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Protocol

import numpy as np

from hostkit.design_file import digest
from hostkit.emulation import (
    avr_board,
    ghdl,
    host_board,
    linux_board,
    rp2040_board,
    stm32_board,
)
from hostkit.emulation.board import (
    BoardRun,
    BuildResult,
    Receive,
    Send,
    Stimulus,
    Stop,
)
from hostkit.emulation.comparison import (
    FLOAT_TOLERANCE_RAD,
    Answer,
    EmulationResult,
    compare,
    compare_with_faults,
)
from hostkit.emulation.fault import Fault, planned_faults
from hostkit.emulation.fault_report import said
from hostkit.emulation.image_room import overflow_bytes, require_room, too_large
from hostkit.errors import BuildError, EmulationError, HostkitError
from hostkit.filters import FILTERS
from hostkit.link.frames.decoder import Decoder, Frame, trace_of
from hostkit.recordings import Recording
from hostkit.records import AXES, FilterDesign
from hostkit.render import FirmwareOptions, read_manifest
from hostkit.render.choices import firmware_options_of
from hostkit.render.link_plan import link_of
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import Counts, to_counts
from hostkit.sensors.mpu6050 import TEMPERATURE_COUNTS_PER_DEG_C, settle_samples
from hostkit.targets import Target
from hostkit.trace import AngleTrace

__all__ = ["EmulationResult", "board_of", "build", "emulate", "stimulus_of"]

Progress = Callable[[int], None]
RETUNED = 4
"""Flag of a TILT_SAMPLE: the filter runs with other parameters than the design's."""


class Board(Protocol):
    """What the module of an emulated board offers."""

    def build(self, folder: Path) -> BuildResult:
        """Build a generated folder."""

    def run(
        self, folder: Path, stimulus: Stimulus, *, progress: Progress | None = None
    ) -> BoardRun:
        """Play a stimulus to its end."""

    def serve(
        self, folder: Path, stimulus: Stimulus, send: Send, stop: Stop, receive: Receive
    ) -> None:
        """Play a stimulus over and over in real time."""


BOARDS: dict[str, Board] = {
    "host": host_board,
    "atmega328p": avr_board,
    "rp2040": rp2040_board,
    "stm32f103": stm32_board,
    "linux": linux_board,
}
"""Emulated boards of the microcontroller targets."""

ROOM_TEMPERATURE_DEG_C = 25.0


def build(folder: Path, target: Target) -> BuildResult | tuple[str, ...]:
    """Build a generated folder: an image for a microcontroller, analysed units for an FPGA.

    Raises
    ------
    BuildError
        If the code does not compile, or does not fit the target's flash.
    ToolMissingError
        If the toolchain is not installed.
    """
    if target.kind == "fpga":
        return ghdl.analyse(folder)
    try:
        built = board_of(target).build(folder)
    except BuildError as error:
        excess_bytes = overflow_bytes(str(error))
        if excess_bytes is None:
            raise
        excess_bytes += target.loader_bytes
        raise too_large(target, _options_of(folder, target), excess_bytes) from error
    require_room(target, _options_of(folder, target), built.flash_bytes)
    return built


def _options_of(folder: Path, target: Target) -> FirmwareOptions:
    return firmware_options_of(target, read_manifest(folder).options)


def board_of(target: Target) -> Board:
    """Return the emulated board of a target.

    Raises
    ------
    HostkitError
        If there is none.
    """
    if target.name not in BOARDS:
        raise HostkitError(f"{target.name} has no emulated board; there are: {', '.join(BOARDS)}")
    return BOARDS[target.name]


def stimulus_of(design: FilterDesign, recording: Recording, *, loop: bool = False) -> Stimulus:
    """Return what the virtual sensor feels when it plays a recording.

    A recording without temperature gets one that changes by a count from row to row: a sensor whose
    data do not change at all is taken for frozen, as no real one is.
    """
    temperature = recording.temperature_deg_c
    if temperature is None:
        count = np.arange(len(recording)) % 2
        temperature = ROOM_TEMPERATURE_DEG_C + count / TEMPERATURE_COUNTS_PER_DEG_C
    return Stimulus(
        angular_rate_rad_s=recording.angular_rate_rad_s,
        specific_force_m_s2=recording.specific_force_m_s2,
        temperature_deg_c=temperature,
        settle_samples=settle_samples(design.sensor, design.rate_hz),
        loop=loop,
    )


def emulate(
    folder: Path,
    target: Target,
    design: FilterDesign,
    recording: Recording,
    progress: Progress | None = None,
    *,
    faults: tuple[Fault, ...] = (),
) -> EmulationResult:
    """Run the built code of a folder on a recording and compare.

    Parameters
    ----------
    folder
        What `hostkit generate` wrote, built.
    design
        The design whose models judge.
    progress
        Called now and then with the number of samples done.
    faults
        What is to go wrong on the virtual sensor meanwhile.

    Raises
    ------
    EmulationError
        If the board crashes, hangs, or runs another design, or if the faults are too many or do not
        fit into the recording.
    ToolMissingError
        If the emulator is not installed.
    """
    part = SENSORS[design.sensor.part]
    counts = to_counts(
        part, design.sensor, recording.angular_rate_rad_s, recording.specific_force_m_s2
    )
    if target.kind == "fpga":
        if faults:
            raise EmulationError(f"{target.name} has no virtual sensor, so no faults of one")
        return compare(target, design, counts, _simulate(folder, design, counts, progress))
    options = _options_of(folder, target)
    every = _every(design, target, options)
    tolerance_rad = FLOAT_TOLERANCE_RAD if options.arithmetic == "float" else None
    stimulus = stimulus_of(design, recording)
    if faults:
        if every > 1:
            raise EmulationError(
                f"TILT_SAMPLE goes out with every {every}th sample; a run with faults is judged "
                f"only if it goes out with every one: TILT_SAMPLE={design.rate_hz:g}"
            )
        planned = planned_faults(faults, len(recording), design.rate_hz)
        run = board_of(target).run(folder, replace(stimulus, faults=planned), progress=progress)
        heard = heard_of(run, target, design)
        return compare_with_faults(target, design, counts, run, heard, faults, tolerance_rad)
    run = board_of(target).run(folder, stimulus, progress=progress)
    answer = answer_of(run, target, design)
    return compare(
        target, design, counts, replace(answer, every=every, tolerance_rad=tolerance_rad)
    )


def _every(design: FilterDesign, target: Target, options: FirmwareOptions) -> int:
    """Return with every how-many-th sample a TILT_SAMPLE goes out."""
    every = link_of(design, target, options).every("TILT_SAMPLE")
    if not every:
        raise EmulationError("TILT_SAMPLE is off, so the device says nothing that can be judged")
    return every


def _simulate(
    folder: Path, design: FilterDesign, counts: Counts, progress: Progress | None
) -> Answer:
    run = ghdl.simulate(folder, counts.accel, counts.gyro, progress=progress)
    _require_digest(run.design_digest, design)
    return Answer(
        row=np.arange(len(counts)),
        counts=counts,
        state_raw=run.state_raw(FILTERS[design.filter].lower(design)),
        cycles_mean=float(run.latency_cycles.mean()),
        cycles_max=float(run.latency_cycles.max()),
    )


def answer_of(run: BoardRun, target: Target, design: FilterDesign) -> Answer:
    """Return the samples that a board sent.

    Raises
    ------
    EmulationError
        If there is none, or one is not of the design.
    """
    frames, trace = heard_of(run, target, design)
    if not len(trace):
        texts = said(frames)
        raise EmulationError(
            f"{target.name} sent {len(frames)} messages but no sample"
            + (f"; it says: {texts[-1]!r}" if texts else "")
        )
    return Answer(
        row=trace.sequence,
        counts=Counts(accel=trace.accel_count, gyro=trace.gyro_count),
        state_raw=trace.state_raw,
        told=trace.told,
        cycles_mean=run.cycles_mean,
        cycles_max=run.cycles_max,
        stack_bytes=run.stack_bytes,
        faults=run.faults,
        cost_unit=run.cost_unit,
    )


def heard_of(run: BoardRun, target: Target, design: FilterDesign) -> tuple[list[Frame], AngleTrace]:
    """Return the messages that a board sent, and those of its samples as a trace.

    Raises
    ------
    EmulationError
        If a sample is of another design, or was made with other parameters.
    """
    frames = Decoder().feed(run.stream)
    samples = [frame.message for frame in frames if frame.name == "TILT_SAMPLE"]
    for message in samples:
        _require_digest(bytes(message.digest).hex(), design)
    retuned = sum(bool(message.flags & RETUNED) for message in samples)
    if retuned:
        raise EmulationError(
            f"{target.name} runs other parameters than the design in {retuned} of {len(samples)} "
            "samples (flag RETUNED): they were set, calibrated or stored, so the design's models "
            "cannot judge them"
        )
    hidden_words = len(FILTERS[design.filter].lower(design).hidden)
    return frames, trace_of(frames, AXES[design.axes], hidden_words=hidden_words)


def _require_digest(found: str, design: FilterDesign) -> None:
    if found != digest(design):
        raise EmulationError(
            f"the code runs design {found}, not {digest(design)}: generate it again"
        )
