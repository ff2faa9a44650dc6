"""The integer model: what the generated C and VHDL compute, bit for bit.

Every word has 32 bits. There are two products, both rounded down: the high word of two words,
``a * b >> 32``, and a gain times a count, ``gain * count >> 15``. No sum leaves its word: see
:mod:`hostkit.filters.observer.lowering`. The order of the steps and their equations are those of
:mod:`hostkit.filters.observer.float_model`; a number after a letter says its fraction bits.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.filters.observer.integer_angles import angles_raw
from hostkit.filters.observer.integer_geometry import (
    HALF_PER_G,
    Row,
    clamped,
    corrected,
    earth_rows,
    normalised,
    propagated,
    upright,
)
from hostkit.filters.observer.limits import TOLD_SQUARE_LEAST, TOLD_SQUARE_MOST
from hostkit.filters.observer.spec import ObserverSpec

IntArray = NDArray[np.int64]
Counts = list[int]

XYZ = range(3)
CLIP_GAIN = 2**26
START_LIMIT = 2**24
"""Largest half-angle of the alignment in a sample, 26 fraction bits."""
SQUARE_LEAST, SQUARE_MOST = round(TOLD_SQUARE_LEAST * 2**60), round(TOLD_SQUARE_MOST * 2**60)
LEVEL = (2**30, 0, 0, 0)


@dataclass(slots=True, kw_only=True)
class _State:
    """The hidden words, in the order of a row of states."""

    quaternion: list[int]
    correction: list[int]
    bias: list[int]
    gyro_mean: list[int]
    accel_mean: list[int]
    start_gain: int
    still: int
    rested: int

    def words(self) -> list[int]:
        return [
            *self.quaternion,
            *self.correction,
            *self.bias,
            *self.gyro_mean,
            *self.accel_mean,
            self.start_gain,
            self.still,
            self.rested,
        ]


def run_integer(
    spec: ObserverSpec,
    accel_count: IntArray,
    gyro_count: IntArray,
    start: IntArray | None = None,
) -> IntArray:
    """Run the integer model from a state, or from its first sample, which loads.

    Parameters
    ----------
    accel_count, gyro_count
        Counts in sensor axes, each of shape ``(N, 3)``.
    start
        State before the first sample, shape ``(S,)``; words of 32 bits. An orientation that no
        device can have counts as level.

    Returns
    -------
    numpy.ndarray
        States, shape ``(N, S)``: the angles of the design's axes, then the words of `spec.hidden`.
    """
    state = None if start is None else _state_of(start[len(spec.axes) :].tolist())
    words, turns = [], []
    for accel, gyro in zip(accel_count.tolist(), gyro_count.tolist(), strict=True):
        if state is None:
            state, turn = load(spec, accel, gyro), [0, 0, 0]
        else:
            turn = step(spec, state, accel, gyro)
        words.append(state.words())
        turns.append(turn)
    return _rows(spec, words, turns)


def step_integer(
    spec: ObserverSpec, state_raw: IntArray, accel_count: IntArray, gyro_count: IntArray
) -> IntArray:
    """Take one step from each of N states, independently of each other.

    Parameters
    ----------
    state_raw
        States before the step, shape ``(N, S)``.
    accel_count, gyro_count
        Counts of the step in sensor axes, each of shape ``(N, 3)``.

    Returns
    -------
    numpy.ndarray
        States after the step, shape ``(N, S)``.
    """
    words, turns = [], []
    hidden = state_raw[:, len(spec.axes) :].tolist()
    for own, accel, gyro in zip(hidden, accel_count.tolist(), gyro_count.tolist(), strict=True):
        state = _state_of(own)
        turns.append(step(spec, state, accel, gyro))
        words.append(state.words())
    return _rows(spec, words, turns)


def load(spec: ObserverSpec, accel: Counts, gyro: Counts) -> _State:
    """Return the state after the first sample: its specific force is up."""
    return _State(
        quaternion=upright(spec, _forces(spec, accel)),
        correction=[0, 0],
        bias=list(spec.gains.bias_raw),
        gyro_mean=[count << 14 for count in gyro] if spec.rest else [0, 0, 0],
        accel_mean=[count << 14 for count in accel] if spec.rest else [0, 0, 0],
        start_gain=spec.start_gain,
        still=0,
        rested=0,
    )


def step(spec: ObserverSpec, state: _State, accel: Counts, gyro: Counts) -> list[int]:
    """Take one sample; return the half-angles that the sensor turned by, 32."""
    at_rest = _rest(spec, state, accel, gyro)
    if at_rest and not state.rested:
        _first_rest(spec, state)
    if spec.clip_count is not None and max(map(abs, gyro)) > spec.clip_count:
        state.start_gain = max(state.start_gain, CLIP_GAIN)
    shift = spec.formats.bias_shift
    turn = [(spec.gyro_gain[i] * gyro[i] >> 15) - (state.bias[i] >> shift) for i in XYZ]
    moved = propagated(state.quaternion, turn)
    x_row, y_row = earth_rows(moved)
    accel_x, accel_y = _accelerations(spec, (x_row, y_row), _forces(spec, accel))
    correction = _correct(spec, state, accel_x, accel_y)
    half_x, half_y = (part >> spec.formats.turn_shift for part in correction)
    if state.start_gain:
        start_x, start_y = _align(spec, state, accel_x, accel_y)
        half_x, half_y = half_x + start_x, half_y + start_y
    state.quaternion = normalised(corrected(moved, half_x, half_y))
    if at_rest:
        _follow_rate(spec, state, turn)
    else:
        _follow_correction(spec, state, (x_row, y_row), correction)
    decay = spec.gains.kv_raw
    state.correction = [part - (part * decay >> 32) for part in state.correction]
    return turn


def _forces(spec: ObserverSpec, accel: Counts) -> Counts:
    gain, offset = spec.accel_gain, spec.accel_offset
    return [(gain[i] * accel[i] >> 15) - offset[i] for i in XYZ]


def _rest(spec: ObserverSpec, state: _State, accel: Counts, gyro: Counts) -> bool:
    """Bring the running means up to date; return whether the sensor is at rest."""
    if spec.rest is None:
        return False
    quiet = _follow(state.gyro_mean, gyro, spec.mean_shift) <= spec.rest.rate_limit
    quiet &= _follow(state.accel_mean, accel, spec.mean_shift) <= spec.rest.force_limit
    quiet &= max(map(abs, state.gyro_mean)) <= spec.mean_limit
    state.still = min(state.still + 1, spec.rest_samples) if quiet else 0
    return state.still == spec.rest_samples


def _follow(mean: list[int], count: Counts, shift: int) -> int:
    """Let the running means follow; return how far the counts were from them at most."""
    apart = [(count[i] << 14) - mean[i] for i in XYZ]
    for i in XYZ:
        mean[i] += apart[i] >> shift
    return max(map(abs, apart))


def _first_rest(spec: ObserverSpec, state: _State) -> None:
    """Take the mean rate for the bias, and align again."""
    shift, limit = spec.formats.first_bias_shift, spec.bias_limit
    state.bias = [
        clamped((spec.gyro_gain[i] * state.gyro_mean[i] >> 32) << shift, limit) for i in XYZ
    ]
    state.start_gain = spec.start_gain
    state.rested = 1


def _accelerations(spec: ObserverSpec, rows: tuple[Row, Row], force: list[int]) -> tuple[int, int]:
    """Return the horizontal acceleration, m/s^2, 24."""
    x, y, z = force
    limit, shift = spec.acceleration_limit, spec.formats.acceleration_shift
    along_x, along_y = ((a * x >> 32) + (b * y >> 32) + (c * z >> 32) for a, b, c in rows)
    return clamped(along_x, limit) << shift, clamped(along_y, limit) << shift


def _correct(spec: ObserverSpec, state: _State, accel_x: int, accel_y: int) -> tuple[int, int]:
    """Add to the velocity, which is kept as the correction that it asks for; return that."""
    gain, limit = spec.gains.kt_raw, spec.correction_limit
    x, y = state.correction
    x = clamped(x + (accel_x * gain >> 32), limit)
    y = clamped(y + (accel_y * gain >> 32), limit)
    state.correction = [x, y]
    return y, -x


def _align(spec: ObserverSpec, state: _State, accel_x: int, accel_y: int) -> tuple[int, int]:
    """Return the half-angles that the alignment at the start asks for, 32."""
    per_force = state.start_gain * HALF_PER_G >> 32
    x = clamped(accel_x * per_force >> 32, START_LIMIT) << 6
    y = clamped(accel_y * per_force >> 32, START_LIMIT) << 6
    gain = state.start_gain - ((state.start_gain * state.start_gain >> 32) << 1)
    state.start_gain = gain = gain if gain > spec.start_end else 0
    state.correction = [part - ((part * gain >> 32) << 1) for part in state.correction]
    return y, -x


def _follow_rate(spec: ObserverSpec, state: _State, turn: list[int]) -> None:
    """Let the bias follow the rate, at rest."""
    gain = 0 if spec.rest is None else spec.rest.gain_raw
    shift, limit = spec.formats.rest_shift, spec.bias_limit
    for i in XYZ:
        state.bias[i] = clamped(state.bias[i] + ((turn[i] << shift) * gain >> 32), limit)


def _follow_correction(
    spec: ObserverSpec, state: _State, rows: tuple[Row, Row], correction: tuple[int, int]
) -> None:
    """Let the bias follow the correction, turned into sensor axes.

    One product is taken off and one is added, so that what they lose by rounding does not add up.
    """
    x, y = correction[0] * spec.gains.kb_raw >> 32, -correction[1] * spec.gains.kb_raw >> 32
    x_row, y_row = rows
    for i in XYZ:
        change = (x_row[i] * x >> 32) - (y_row[i] * y >> 32)
        state.bias[i] = clamped(state.bias[i] - change, spec.bias_limit)


def _rows(spec: ObserverSpec, words: list[list[int]], turns: list[list[int]]) -> IntArray:
    hidden = np.array(words, dtype=np.int64).reshape(-1, len(spec.hidden))
    turn = np.array(turns, dtype=np.int64).reshape(-1, 3)
    return np.hstack([angles_raw(spec, hidden[:, :4], turn), hidden])


def _state_of(words: list[int]) -> _State:
    square = sum(word * word for word in words[0:4])
    return _State(
        quaternion=words[0:4] if SQUARE_LEAST <= square <= SQUARE_MOST else list(LEVEL),
        correction=words[4:6],
        bias=words[6:9],
        gyro_mean=words[9:12],
        accel_mean=words[12:15],
        start_gain=words[15],
        still=words[16],
        rested=words[17],
    )
