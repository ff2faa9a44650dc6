"""Holding what a target answered to a recording against the models."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.attitude import apart_rad, wrap_rad
from hostkit.emulation.board import BoardRun
from hostkit.emulation.fault import Fault
from hostkit.emulation.fault_report import (
    FaultReport,
    answers_of_models,
    is_active,
    last_errors,
    repeats,
    rows_of,
    said,
)
from hostkit.filters import FILTERS
from hostkit.link.frames.decoder import Frame
from hostkit.records import AXES, FilterDesign, read_only
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import Counts, to_rate_and_force_g
from hostkit.targets import Target
from hostkit.trace import AngleTrace, ToldState
from hostkit.units import RAD_PER_HALF_TURN_LSB

Vector = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

FLOAT_TOLERANCE_RAD = 1e-5
"""How far a filter in float may be from the model, which computes in double; 0.0006 deg."""


@dataclass(frozen=True, slots=True, kw_only=True)
class EmulationResult:
    """What a target answered to a recording.

    Attributes
    ----------
    samples, missing
        Samples that came back, and samples that were to come and did not.
    mismatches
        Samples whose raw counts differ, or whose state: from the integer model in any bit, or,
        with a tolerance, from the float model by more. A state that was told of a sample beside
        it counts with it, or by itself where that sample did not come back.
    states_told
        How many states were told beside the samples; None of a filter whose samples have it all.
    residual_rad
        Device minus float model, shape ``(samples, A)``.
    max_abs_error_rad
        How far the device is from the float model at most: the angle, or the up direction of two;
        None if nothing came back.
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
    tolerance_rad
        How far a filter that computes in float may be from the float model; None for one that
        computes in integers, whose every bit must be the integer model's.
    """

    target: str
    samples: int
    missing: int
    mismatches: int
    residual_rad: Vector
    max_abs_error_rad: float | None
    cycles_mean: float | None
    cycles_max: float | None
    stack_bytes: int | None
    faults: tuple[tuple[str, int], ...]
    fault_report: FaultReport | None = None
    cost_unit: str = "cycles"
    tolerance_rad: float | None = None
    states_told: int | None = None

    def __post_init__(self) -> None:
        """Make the array read-only."""
        read_only(self.residual_rad)

    @property
    def passed(self) -> bool:
        """Whether every sample came back as the model says.

        A run with faults may lose samples, but must recover, and what it sends must be right.
        """
        if self.fault_report is not None:
            return self.fault_report.recovered and self.mismatches == 0
        return self.samples > 0 and self.missing == 0 and self.mismatches == 0


@dataclass(frozen=True, slots=True, kw_only=True)
class Answer:
    """Rows of the recording that came back, with counts and states.

    Attributes
    ----------
    row
        Which row of the recording each is, shape ``(N,)``.
    every
        Only every so many-th row was to come, from the first on.
    tolerance_rad
        As in :class:`EmulationResult`.
    told
        States that came beside the samples; their counters are rows.
    """

    row: IntArray
    counts: Counts
    state_raw: IntArray
    cycles_mean: float | None
    cycles_max: float | None
    stack_bytes: int | None = None
    faults: tuple[tuple[str, int], ...] = ()
    cost_unit: str = "cycles"
    every: int = 1
    tolerance_rad: float | None = None
    told: tuple[ToldState, ...] = ()


def compare(
    target: Target, design: FilterDesign, counts: Counts, answer: Answer
) -> EmulationResult:
    """Hold an answer against the models, which run through the whole recording once.

    Parameters
    ----------
    counts
        What the sensor gives for the recording.
    """
    filter_, part = FILTERS[design.filter], SENSORS[design.sensor.part]
    spec = filter_.lower(design)
    wanted = filter_.run_integer(spec, counts.accel, counts.gyro)
    axes = len(AXES[design.axes])
    exact = filter_.run_float(design, *to_rate_and_force_g(part, design.sensor, counts))[:, :axes]
    inside = (answer.row >= 0) & (answer.row < len(counts))
    row = np.where(inside, answer.row, 0)
    residual = _residual_rad(answer.state_raw, exact[row])
    wrong = (
        ~inside
        | _state_wrong(answer.state_raw, wanted[row], exact[row], answer.tolerance_rad)
        | (answer.counts.accel != counts.accel[row]).any(axis=1)
        | (answer.counts.gyro != counts.gyro[row]).any(axis=1)
    )
    expected = np.arange(0, len(counts), answer.every)
    places = np.arange(len(counts)), answer.row
    alone = 0 if answer.tolerance_rad else _mark_told(answer.told, wanted[:, axes:], places, wrong)
    return EmulationResult(
        target=target.name,
        samples=len(answer.row),
        missing=len(np.setdiff1d(expected, answer.row)),
        mismatches=int(wrong.sum()) + alone,
        states_told=len(answer.told) if spec.tells_state else None,
        residual_rad=residual,
        max_abs_error_rad=_max_abs_error_rad(answer.state_raw, exact[row]),
        cycles_mean=answer.cycles_mean,
        cycles_max=answer.cycles_max,
        stack_bytes=answer.stack_bytes,
        faults=answer.faults,
        cost_unit=answer.cost_unit,
        tolerance_rad=answer.tolerance_rad,
    )


def compare_with_faults(
    target: Target,
    design: FilterDesign,
    counts: Counts,
    run: BoardRun,
    heard: tuple[list[Frame], AngleTrace],
    faults: tuple[Fault, ...],
    tolerance_rad: float | None,
) -> EmulationResult:
    """Hold what came back against the models, run anew from every restart that the device tells."""
    frames, trace = heard
    sent = Counts(accel=trace.accel_count, gyro=trace.gyro_count)
    elapsed = np.diff(trace.time_us, prepend=0) * 1e-6 * design.rate_hz
    spoilt_axes = int(any(fault.spoils_an_axis for fault in faults))
    row, spoilt = rows_of(sent, counts, np.ceil(elapsed).astype(np.int64), spoilt_axes=spoilt_axes)
    repeated = repeats(sent) & (row < 0)
    wanted, exact = answers_of_models(design, sent, trace.restarted)
    residual = _residual_rad(trace.state_raw, exact)
    wrong = _state_wrong(trace.state_raw, wanted, exact, tolerance_rad)
    wrong |= (row < 0) & ~repeated
    hidden, places = wanted[:, exact.shape[1] :], (trace.sequence, trace.sequence)
    alone = 0 if tolerance_rad else _mark_told(trace.told, hidden, places, wrong)
    return EmulationResult(
        target=target.name,
        samples=len(trace),
        missing=len(counts) - int((row >= 0).sum()),
        mismatches=int(wrong.sum()) + alone,
        states_told=len(trace.told) if FILTERS[design.filter].lower(design).tells_state else None,
        residual_rad=residual,
        max_abs_error_rad=_max_abs_error_rad(trace.state_raw, exact),
        cycles_mean=run.cycles_mean,
        cycles_max=run.cycles_max,
        stack_bytes=run.stack_bytes,
        faults=run.faults,
        cost_unit=run.cost_unit,
        tolerance_rad=tolerance_rad,
        fault_report=FaultReport(
            injected=tuple(str(fault) for fault in faults),
            struck=dict(run.faults).get("struck", 0),
            errors=last_errors(frames),
            restarts=max(int(trace.restarted.sum()) - 1, 0),
            texts=said(frames),
            repeated=int(repeated.sum()),
            spoilt=int(spoilt.sum()),
            recovered=_recovered(frames, row, len(counts)),
        ),
    )


def _recovered(frames: list[Frame], row: IntArray, samples: int) -> bool:
    """Return whether the last sample came and the device says that it is active."""
    return bool(len(row) and row[-1] == samples - 1 and is_active(frames))


def _residual_rad(state_raw: IntArray, exact: Vector) -> Vector:
    axes = exact.shape[1]
    return wrap_rad(state_raw[:, :axes] * RAD_PER_HALF_TURN_LSB - exact)


def _max_abs_error_rad(state_raw: IntArray, exact: Vector) -> float | None:
    return float(_apart_rad(state_raw, exact).max()) if len(exact) else None


def _apart_rad(state_raw: IntArray, exact: Vector) -> Vector:
    return apart_rad(state_raw[:, : exact.shape[1]] * RAD_PER_HALF_TURN_LSB, exact)


def _state_wrong(
    state_raw: IntArray, wanted: IntArray, exact: Vector, tolerance_rad: float | None
) -> BoolArray:
    """Tell which states are not the model's: in any bit, or by more than the tolerance.

    They may be the angles only.
    """
    if tolerance_rad is not None:
        return np.asarray(~(_apart_rad(state_raw, exact) <= tolerance_rad))  # NaN is wrong
    return np.asarray((state_raw != wanted[:, : state_raw.shape[1]]).any(axis=1))


def _mark_told(
    told: tuple[ToldState, ...],
    wanted: IntArray,
    places: tuple[IntArray, IntArray],
    wrong: BoolArray,
) -> int:
    """Mark samples whose told state is wrong; return how many states were wrong without one.

    Parameters
    ----------
    wanted
        Hidden words of the model, shape ``(M, W)``.
    places
        Counters of its rows, shape ``(M,)``, and those of the samples, shape ``(N,)``. A device
        that started anew has a counter more than once; its state must be that of one of them.
    wrong
        Of the samples, shape ``(N,)``; changed.
    """
    of_model, of_samples = places
    alone = 0
    for state in told:
        if not (wanted[of_model == state.sequence] == state.words_raw).all(axis=1).any():
            of_sample = np.flatnonzero(of_samples == state.sequence)
            wrong[of_sample[-1:]] = True
            alone += not len(of_sample)
    return alone
