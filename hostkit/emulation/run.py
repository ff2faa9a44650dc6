"""Running generated code on a recording, and holding what it says against the models."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from hostkit.attitude import wrap_rad
from hostkit.design_file import digest
from hostkit.emulation import avr_board, ghdl, host_board, rp2040_board, stm32_board
from hostkit.emulation.board import (
    BoardRun,
    BuildResult,
    Receive,
    Send,
    Stimulus,
    Stop,
)
from hostkit.emulation.fault import Fault, planned_faults
from hostkit.emulation.fault_report import (
    FaultReport,
    answers_of_models,
    is_active,
    last_errors,
    repeats,
    rows_of,
    said,
)
from hostkit.errors import EmulationError, HostkitError
from hostkit.filters import FILTERS
from hostkit.link.decoder import Decoder, Frame, trace_of
from hostkit.recordings import Recording
from hostkit.records import AXES, AngleTrace, FilterDesign, read_only
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import Counts, to_counts, to_rate_and_force_g
from hostkit.sensors.mpu6050 import TEMPERATURE_COUNTS_PER_DEG_C, settle_samples
from hostkit.targets import Target
from hostkit.units import RAD_PER_HALF_TURN_LSB

Vector = NDArray[np.float64]
IntArray = NDArray[np.int64]
Progress = Callable[[int], None]


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
}
"""Emulated boards of the microcontroller targets."""

ROOM_TEMPERATURE_DEG_C = 25.0


@dataclass(frozen=True, slots=True, kw_only=True)
class EmulationResult:
    """What a target answered to a recording.

    Attributes
    ----------
    samples, missing
        Samples that came back, and samples of the recording that did not.
    mismatches
        Samples whose raw counts or state differ from the integer model's.
    residual_rad
        Device minus float model, shape ``(samples, A)``.
    cycles_mean, cycles_max
        Cost of a filter update; None where nothing counts it.
    stack_bytes
        Deepest stack; None where nothing measures it.
    faults
        What went wrong on the board, by name.
    fault_report
        What became of the faults that were asked for; None if none were.
    cost_unit
        What the cost is counted in: clock ``cycles``, or ``instructions`` where the emulator
        knows no cycles.
    """

    target: str
    samples: int
    missing: int
    mismatches: int
    residual_rad: Vector
    cycles_mean: float | None
    cycles_max: float | None
    stack_bytes: int | None
    faults: tuple[tuple[str, int], ...]
    fault_report: FaultReport | None = None
    cost_unit: str = "cycles"

    def __post_init__(self) -> None:
        """Make the array read-only."""
        read_only(self.residual_rad)

    @property
    def max_abs_error_rad(self) -> float | None:
        """Largest residual, or None if nothing came back."""
        return float(np.abs(self.residual_rad).max()) if self.residual_rad.size else None

    @property
    def passed(self) -> bool:
        """Whether every sample came back as the integer model says.

        A run with faults may lose samples, but must recover, and what it sends must be right.
        """
        if self.fault_report is not None:
            return self.fault_report.recovered and self.mismatches == 0
        return self.samples > 0 and self.missing == 0 and self.mismatches == 0


@dataclass(frozen=True, slots=True, kw_only=True)
class _Answer:
    """Rows of the recording that came back, with counts and states."""

    row: IntArray
    counts: Counts
    state_raw: IntArray
    cycles_mean: float | None
    cycles_max: float | None
    stack_bytes: int | None = None
    faults: tuple[tuple[str, int], ...] = ()
    cost_unit: str = "cycles"


def build(folder: Path, target: Target) -> BuildResult | tuple[str, ...]:
    """Build a generated folder: an image for a microcontroller, analysed units for an FPGA.

    Raises
    ------
    BuildError
        If the code does not compile.
    ToolMissingError
        If the toolchain is not installed.
    """
    if target.kind == "fpga":
        return ghdl.analyse(folder)
    return board_of(target).build(folder)


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
    if faults:
        if target.kind == "fpga":
            raise EmulationError(f"{target.name} has no virtual sensor, so no faults of one")
        planned = planned_faults(faults, len(recording), design.rate_hz)
        stimulus = replace(stimulus_of(design, recording), faults=planned)
        run = board_of(target).run(folder, stimulus, progress=progress)
        return _compare_with_faults(target, design, counts, run, faults)
    if target.kind == "fpga":
        answer = _simulate(folder, design, counts, progress)
    else:
        answer = _run(folder, target, design, recording, progress)
    return _compare(target, design, counts, answer)


def _simulate(
    folder: Path, design: FilterDesign, counts: Counts, progress: Progress | None
) -> _Answer:
    run = ghdl.simulate(folder, counts.accel, counts.gyro, progress=progress)
    _require_digest(run.design_digest, design)
    return _Answer(
        row=np.arange(len(counts)),
        counts=counts,
        state_raw=run.state_raw(FILTERS[design.filter].lower(design)),
        cycles_mean=float(run.latency_cycles.mean()),
        cycles_max=float(run.latency_cycles.max()),
    )


def _run(
    folder: Path,
    target: Target,
    design: FilterDesign,
    recording: Recording,
    progress: Progress | None,
) -> _Answer:
    run = board_of(target).run(folder, stimulus_of(design, recording), progress=progress)
    frames, trace = _heard(run, design)
    if not len(trace):
        texts = said(frames)
        raise EmulationError(
            f"{target.name} sent {len(frames)} messages but no sample"
            + (f"; it says: {texts[-1]!r}" if texts else "")
        )
    return _Answer(
        row=trace.sequence,
        counts=Counts(accel=trace.accel_count, gyro=trace.gyro_count),
        state_raw=trace.state_raw,
        cycles_mean=run.cycles_mean,
        cycles_max=run.cycles_max,
        stack_bytes=run.stack_bytes,
        faults=run.faults,
        cost_unit=run.cost_unit,
    )


def _heard(run: BoardRun, design: FilterDesign) -> tuple[list[Frame], AngleTrace]:
    frames = Decoder().feed(run.stream)
    for frame in frames:
        if frame.name == "TILT_SAMPLE":
            _require_digest(bytes(frame.message.digest).hex(), design)
    hidden_words = len(FILTERS[design.filter].lower(design).hidden)
    return frames, trace_of(frames, AXES[design.axes], hidden_words=hidden_words)


def _require_digest(found: str, design: FilterDesign) -> None:
    if found != digest(design):
        raise EmulationError(
            f"the code runs design {found}, not {digest(design)}: generate it again"
        )


def _compare(
    target: Target, design: FilterDesign, counts: Counts, answer: _Answer
) -> EmulationResult:
    filter_, part = FILTERS[design.filter], SENSORS[design.sensor.part]
    wanted = filter_.run_integer(filter_.lower(design), counts.accel, counts.gyro)
    axes = len(AXES[design.axes])
    exact = filter_.run_float(design, *to_rate_and_force_g(part, design.sensor, counts))[:, :axes]
    inside = (answer.row >= 0) & (answer.row < len(counts))
    row = np.where(inside, answer.row, 0)
    wrong = (
        ~inside
        | (answer.state_raw != wanted[row]).any(axis=1)
        | (answer.counts.accel != counts.accel[row]).any(axis=1)
        | (answer.counts.gyro != counts.gyro[row]).any(axis=1)
    )
    return EmulationResult(
        target=target.name,
        samples=len(answer.row),
        missing=len(counts) - len(np.unique(answer.row[inside])),
        mismatches=int(wrong.sum()),
        residual_rad=wrap_rad(answer.state_raw[:, :axes] * RAD_PER_HALF_TURN_LSB - exact[row]),
        cycles_mean=answer.cycles_mean,
        cycles_max=answer.cycles_max,
        stack_bytes=answer.stack_bytes,
        faults=answer.faults,
        cost_unit=answer.cost_unit,
    )


def _compare_with_faults(
    target: Target, design: FilterDesign, counts: Counts, run: BoardRun, faults: tuple[Fault, ...]
) -> EmulationResult:
    """Hold what came back against the models, run anew from every restart that the device tells."""
    frames, trace = _heard(run, design)
    sent = Counts(accel=trace.accel_count, gyro=trace.gyro_count)
    elapsed = np.diff(trace.time_us, prepend=0) * 1e-6 * design.rate_hz
    row, spoilt = rows_of(
        sent,
        counts,
        np.ceil(elapsed).astype(np.int64),
        spoilt_axes=int(any(fault.spoils_an_axis for fault in faults)),
    )
    repeated = repeats(sent) & (row < 0)
    wanted, exact = answers_of_models(design, sent, trace.restarted)
    axes = len(AXES[design.axes])
    wrong = (trace.state_raw != wanted).any(axis=1) | ((row < 0) & ~repeated)
    return EmulationResult(
        target=target.name,
        samples=len(trace),
        missing=len(counts) - int((row >= 0).sum()),
        mismatches=int(wrong.sum()),
        residual_rad=wrap_rad(trace.state_raw[:, :axes] * RAD_PER_HALF_TURN_LSB - exact),
        cycles_mean=run.cycles_mean,
        cycles_max=run.cycles_max,
        stack_bytes=run.stack_bytes,
        faults=run.faults,
        cost_unit=run.cost_unit,
        fault_report=FaultReport(
            injected=tuple(str(fault) for fault in faults),
            struck=dict(run.faults).get("struck", 0),
            errors=last_errors(frames),
            restarts=max(int(trace.restarted.sum()) - 1, 0),
            texts=said(frames),
            repeated=int(repeated.sum()),
            spoilt=int(spoilt.sum()),
            recovered=bool(len(row) and row[-1] == len(counts) - 1 and is_active(frames)),
        ),
    )
