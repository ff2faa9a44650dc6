"""What became of a run with faults: what the firmware said, and whether all it sent is true."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.filters import FILTERS
from hostkit.link.frames.decoder import Frame
from hostkit.records import AXES, FilterDesign
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import Counts, to_rate_and_force_g

Vector = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]
ACTIVE = 4
"""MAV_STATE_ACTIVE of the heartbeat."""
SEARCH_MARGIN = 8
"""Rows that may be lost beyond those that the time stamps tell of."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FaultReport:
    """What was injected, what the firmware reported, and how it ended.

    Attributes
    ----------
    injected
        The faults that were planned.
    struck
        How many of them came.
    errors
        The error counter of the last sample.
    restarts
        How often the filter began anew, the first time not counted.
    texts
        What the firmware said, each text once, in order.
    repeated
        Samples that only repeat the one before: the sensor had frozen and it was not yet known.
    spoilt
        Samples of which one axis is not the recording's, in a run with a fault that does so and
        cannot be told from motion.
    recovered
        Whether the last row of the recording came back and the firmware is active at the end.
    """

    injected: tuple[str, ...]
    struck: int
    errors: int
    restarts: int
    texts: tuple[str, ...]
    repeated: int
    spoilt: int
    recovered: bool


def rows_of(
    counts: Counts, wanted: Counts, elapsed: IntArray, *, spoilt_axes: int = 0
) -> tuple[IntArray, BoolArray]:
    """Return which row of a recording each sample is, -1 where it is none, and which are spoilt.

    Rows may be lost but not change their order, and not more than the time stamps allow.

    Parameters
    ----------
    counts
        What a device sent.
    wanted
        What the sensor gives for the recording.
    elapsed
        Sample periods since the sample before, shape ``(N,)``.
    spoilt_axes
        So many of the six counts of a sample may be others than the row's.
    """
    sent = np.hstack([counts.accel, counts.gyro])
    table = np.hstack([wanted.accel, wanted.gyro])
    rows = np.full(len(sent), -1, dtype=np.int64)
    spoilt = np.zeros(len(sent), dtype=np.bool_)
    following = passed = 0
    for i, sample in enumerate(sent):
        passed += int(elapsed[i])
        window = table[following : following + passed + SEARCH_MARGIN]
        wrong = (window != sample).sum(axis=1)
        if wrong.size and wrong.min() <= spoilt_axes:
            rows[i] = following + int(wrong.argmin())
            spoilt[i] = wrong.min() > 0
            following, passed = int(rows[i]) + 1, 0
    return rows, spoilt


def repeats(counts: Counts) -> BoolArray:
    """Tell which samples have the counts of the one before, shape ``(N,)``."""
    sent = np.hstack([counts.accel, counts.gyro])
    same = np.zeros(len(sent), dtype=np.bool_)
    same[1:] = (sent[1:] == sent[:-1]).all(axis=1)
    return same


def said(frames: list[Frame]) -> tuple[str, ...]:
    """Return the texts of a device, each once, in the order of their first appearance."""
    return tuple(dict.fromkeys(str(f.message.text) for f in frames if f.name == "STATUSTEXT"))


def is_active(frames: list[Frame]) -> bool:
    """Tell whether the last heartbeat says that all is well."""
    states = [int(f.message.system_status) for f in frames if f.name == "HEARTBEAT"]
    return bool(states) and states[-1] == ACTIVE


def last_errors(frames: list[Frame]) -> int:
    """Return the error counter of the last sample, 0 if there is none."""
    errors = [int(f.message.i2c_errors) for f in frames if f.name == "TILT_SAMPLE"]
    return errors[-1] if errors else 0


def answers_of_models(
    design: FilterDesign, counts: Counts, restarted: BoolArray
) -> tuple[IntArray, Vector]:
    """Return integer states and the float model's angles, rad, both run anew from every restart.

    Parameters
    ----------
    counts
        What a device sent.
    restarted
        Where it says that its filter began anew, shape ``(N,)``.
    """
    filter_, part = FILTERS[design.filter], SENSORS[design.sensor.part]
    spec, axes = filter_.lower(design), len(AXES[design.axes])
    states = np.zeros((len(counts), axes + len(spec.hidden)), dtype=np.int64)
    angles = np.zeros((len(counts), axes))
    begins = np.unique([0, *np.flatnonzero(restarted)])
    for begin, end in zip(begins, [*begins[1:], len(counts)], strict=True):
        piece = Counts(accel=counts.accel[begin:end], gyro=counts.gyro[begin:end])
        if len(piece):
            si = to_rate_and_force_g(part, design.sensor, piece)
            states[begin:end] = filter_.run_integer(spec, piece.accel, piece.gyro)
            angles[begin:end] = filter_.run_float(design, *si)[:, :axes]
    return states, angles
