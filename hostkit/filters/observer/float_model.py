r"""The float model of the bounded-velocity observer.

The state is the orientation q (a unit quaternion, sensor to earth, earth z up), the horizontal
velocity v and the gyroscope bias b. With the period dt, the rate w and the specific force f, both
calibrated, a step is::

    q <- q * exp((w - b) dt / 2)        half-angle series
    a  = (R(q) f)_xy                    gravity has no horizontal part
    v <- v + a dt
    d  = kt (v_y, -v_x, 0) dt           a turn about an earth axis
    q <- (1, d / 2) * q                 renormalised to first order
    b <- b - kb R^T d                   with the R of the line of a
    v <- (1 - kv dt) v

An error e of tilt lets gravity seem to be an acceleration g e. Where the true acceleration is left
out and both are small, with the velocity taken along the axis that is out::

    e' = -kt v + b        v' = g e - kv v        b' = -kb kt v

whose characteristic polynomial is s^3 + kv s^2 + kt g s + kb kt g: for kb = 0 tilt and velocity are
an oscillator of frequency sqrt(kt g) (0.44 rad/s at kt = 0.02), damped by kv. By Routh's criterion
it is stable where kb < kv. What a filter that compares directions believes of a force, this one
believes of its integral: an acceleration that lasts less than 1 / kv hardly tilts it.

Around that step stand four things that a design may leave out:

- *Start.* The first sample's force is up. Then q is also turned by a share of the tilt that the
  force shows, alpha / g (a_y, -a_x), of which the bias learns nothing, with alpha falling as 1 / n,
  which is a mean that turns with the body: alpha <- alpha - alpha^2 from 1/2 until it is below
  dt / start. The velocity keeps 1 - alpha of itself, with the new alpha. After a rate that was
  clipped alpha is CLIP_GAIN again, if it is less.
- *Rest.* Running means of rate and force that no reading left for REST_TIME_S, and a mean rate
  that can be a bias, are rest: then the bias follows the rate, b <- b + rest_gain (w - b) dt,
  instead of the velocity. The first rest takes the mean rate for the bias and starts again.
- *Lead.* The up direction u is told as u - lead (w - b) x u.
- *Calibration*: w = (1 + gyro_scale) gyro, f = (1 + accel_scale) (accel - accel_offset), and b
  starts from (1 + gyro_scale) gyro_bias.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.attitude import pitch_from_up, roll_from_up, to_body
from hostkit.filters.observer.float_geometry import (
    clamped,
    corrected,
    led,
    normalised,
    propagated,
    rows,
    up,
    upright,
)
from hostkit.filters.observer.limits import (
    ACCELERATION_LIMIT_M_S2,
    CLIP_GAIN,
    REST_RATE_LIMIT_RAD_S,
    START_GAIN,
    START_LIMIT_RAD,
    TOLD_SQUARE_LEAST,
    TOLD_SQUARE_MOST,
    correction_limit_rad,
    mean_shift,
    rest_samples,
    start_end,
)
from hostkit.filters.observer.parameters import BIAS_LIMIT_RAD_S
from hostkit.filters.observer.settings import Settings, settings
from hostkit.records import AXES, FilterDesign
from hostkit.units import STANDARD_GRAVITY_M_S2

Vector = NDArray[np.float64]

XYZ = range(3)


@dataclass(slots=True, kw_only=True)
class _State:
    """What the filter remembers; the order of a row of states."""

    quaternion: list[float]
    velocity: list[float]
    bias: list[float]
    rate_mean: list[float]
    force_mean: list[float]
    start_gain: float
    still_s: float
    rested: float

    def row(self) -> list[float]:
        lists = self.quaternion, self.velocity, self.bias, self.rate_mean, self.force_mean
        return [*(x for part in lists for x in part), self.start_gain, self.still_s, self.rested]


def run_float(
    design: FilterDesign, rate_rad_s: Vector, force_g: Vector, start: Vector | None = None
) -> Vector:
    """Run the float model.

    Parameters
    ----------
    design
        A design of this filter.
    rate_rad_s, force_g
        Angular rate and specific force (in g) in sensor axes, each of shape ``(N, 3)``.
    start
        State before the first sample, shape ``(S,)``; without it the first sample loads. An
        orientation that no device can have counts as level.

    Returns
    -------
    numpy.ndarray
        States, shape ``(N, S)``: the angles of the design's axes (rad), then the quaternion (4),
        the velocity (m/s, 2), the bias (rad/s, 3), the running means of rate (rad/s, 3) and force
        (m/s^2, 3), the weight of the start, the time at rest (s), and 1 after the first rest.

    Raises
    ------
    DesignError
        If a parameter is not possible.
    """
    own = settings(design)
    step = _Step(own, design.period_s)
    state = None if start is None else _state_of(start[len(AXES[design.axes]) :].tolist())
    ups, states = [], []
    force_m_s2 = force_g * STANDARD_GRAVITY_M_S2
    for rate, force in zip(rate_rad_s.tolist(), force_m_s2.tolist(), strict=True):
        if state is None:
            state = step.load(rate, force)
            turn_rad_s = [0.0, 0.0, 0.0]
        else:
            turn_rad_s = step.take(state, rate, force)
        ups.append(led(up(state.quaternion), turn_rad_s, own.lead_s))
        states.append(state.row())
    body = to_body(design.mounting, np.array(ups).reshape(-1, 3))
    angles = {"roll": roll_from_up(body), "pitch": pitch_from_up(body)}
    chosen = np.stack([angles[axis] for axis in AXES[design.axes]], axis=-1)
    return np.hstack([chosen, np.array(states).reshape(len(ups), -1)])


class _Step:
    """One step at a time, with what does not change between them."""

    def __init__(self, own: Settings, period_s: float) -> None:
        self.own, self.period_s = own, period_s
        self.mean_weight = 2.0 ** -mean_shift(period_s)
        self.rest_s = rest_samples(period_s) * period_s
        self.velocity_limit = correction_limit_rad(period_s) / (own.kt_rad_m * period_s)
        self.start_end = start_end(own.start_s, period_s)
        self.start_gain = START_GAIN if self.start_end < START_GAIN else 0.0

    def load(self, rate: list[float], force: list[float]) -> _State:
        """Return the state after the first sample: its specific force is up."""
        cal = self.own.calibration
        return _State(
            quaternion=upright(self._force(force)),
            velocity=[0.0, 0.0],
            bias=[(1.0 + s) * b for s, b in zip(cal.gyro_scale, cal.gyro_bias_rad_s, strict=True)],
            rate_mean=list(rate) if self.own.rest else [0.0] * 3,
            force_mean=list(force) if self.own.rest else [0.0] * 3,
            start_gain=self.start_gain,
            still_s=0.0,
            rested=0.0,
        )

    def take(self, state: _State, rate: list[float], force: list[float]) -> list[float]:
        """Take one sample; return the rate less its bias."""
        at_rest = self._rest(state, rate, force)
        scale = self.own.calibration.gyro_scale
        if at_rest and state.rested == 0.0:
            self._first_rest(state)
        if max(abs(w) for w in rate) > (self.own.clip_rate_rad_s or math.inf):
            state.start_gain = max(state.start_gain, CLIP_GAIN)
        turn = [(1.0 + scale[i]) * rate[i] - state.bias[i] for i in XYZ]
        state.quaternion = propagated(state.quaternion, [0.5 * self.period_s * w for w in turn])
        x_row, y_row = rows(state.quaternion)
        accel = self._acceleration((x_row, y_row), self._force(force))
        turn_x, turn_y = self._correction(state, accel)
        start_x, start_y = self._start(state, accel)
        half = 0.5 * (turn_x + start_x), 0.5 * (turn_y + start_y)
        state.quaternion = normalised(corrected(state.quaternion, half))
        for i in XYZ:
            if at_rest and self.own.rest:
                change = self.own.rest.gain_per_s * self.period_s * turn[i]
            else:
                change = -self.own.kb_per_s * (x_row[i] * turn_x + y_row[i] * turn_y)
            state.bias[i] = clamped(state.bias[i] + change, BIAS_LIMIT_RAD_S)
        kept = 1.0 - self.own.kv_per_s * self.period_s
        state.velocity = [kept * v for v in state.velocity]
        return turn

    def _force(self, force: list[float]) -> list[float]:
        cal = self.own.calibration
        return [(1.0 + cal.accel_scale[i]) * (force[i] - cal.accel_offset_m_s2[i]) for i in XYZ]

    def _rest(self, state: _State, rate: list[float], force: list[float]) -> bool:
        """Bring the running means up to date; return whether the sensor is at rest."""
        rest = self.own.rest
        if rest is None:
            return False
        quiet = _follow(state.rate_mean, rate, self.mean_weight) <= rest.rate_rad_s
        quiet &= _follow(state.force_mean, force, self.mean_weight) <= rest.force_m_s2
        quiet &= max(abs(mean) for mean in state.rate_mean) <= REST_RATE_LIMIT_RAD_S
        state.still_s = min(state.still_s + self.period_s, self.rest_s) if quiet else 0.0
        return state.still_s > self.rest_s - 0.5 * self.period_s

    def _first_rest(self, state: _State) -> None:
        """Take the mean rate for the bias, and align again."""
        scale = self.own.calibration.gyro_scale
        state.bias = [clamped((1.0 + scale[i]) * state.rate_mean[i], BIAS_LIMIT_RAD_S) for i in XYZ]
        state.start_gain = self.start_gain
        state.rested = 1.0

    def _acceleration(
        self, earth: tuple[list[float], list[float]], force: list[float]
    ) -> tuple[float, float]:
        x, y = (sum(r * f for r, f in zip(row, force, strict=True)) for row in earth)
        return clamped(x, ACCELERATION_LIMIT_M_S2), clamped(y, ACCELERATION_LIMIT_M_S2)

    def _correction(self, state: _State, accel: tuple[float, float]) -> tuple[float, float]:
        """Add to the velocity; return the turn that it asks for, rad."""
        limit, period_s = self.velocity_limit, self.period_s
        v_x, v_y = (
            clamped(v + a * period_s, limit) for v, a in zip(state.velocity, accel, strict=True)
        )
        state.velocity = [v_x, v_y]
        gain = self.own.kt_rad_m * period_s
        return gain * v_y, -gain * v_x

    def _start(self, state: _State, accel: tuple[float, float]) -> tuple[float, float]:
        """Return the turn that the alignment at the start asks for, rad."""
        alpha = state.start_gain
        if alpha == 0.0:
            return 0.0, 0.0
        after = alpha - alpha * alpha
        state.start_gain = after if after > self.start_end else 0.0
        state.velocity = [(1.0 - state.start_gain) * v for v in state.velocity]
        x, y = (clamped(alpha * a / STANDARD_GRAVITY_M_S2, START_LIMIT_RAD) for a in accel)
        return y, -x


def _follow(mean: list[float], reading: list[float], weight: float) -> float:
    """Let the running means follow; return how far the reading was from them at most."""
    apart = [x - m for x, m in zip(reading, mean, strict=True)]
    for i in XYZ:
        mean[i] += weight * apart[i]
    return max(abs(x) for x in apart)


def _state_of(words: list[float]) -> _State:
    square = sum(part * part for part in words[0:4])
    is_possible = TOLD_SQUARE_LEAST <= square <= TOLD_SQUARE_MOST
    return _State(
        quaternion=words[0:4] if is_possible else [1.0, 0.0, 0.0, 0.0],
        velocity=words[4:6],
        bias=words[6:9],
        rate_mean=words[9:12],
        force_mean=words[12:15],
        start_gain=words[15],
        still_s=words[16],
        rested=words[17],
    )
