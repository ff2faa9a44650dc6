"""What a filter of one angle neglects: the rates of the other axes, and the error they make.

With roll r, pitch p and body rates w, a rigid body turns by (J. Diebel, "Representing attitude",
Stanford 2006)::

    r' = w_x + w_y sin(r) tan(p) + w_z cos(r) tan(p)
    p' = w_y cos(r) - w_z sin(r)

A filter of one angle integrates w_x for r' and w_y for p'. The difference is its rate error. Here
it is taken over whole steps, from the turn of the up direction, so that it stays finite where the
tangent does not. With dt the period, c the rate error times dt, and eta the weight of the
integrated rate, the angle is then wrong by ::

    e_k = eta (e_(k-1) + c_k),    e_0 = 0

The whole error of the filter, against the same tilt, has a second part, of the tilt m measured
from the specific force and of the gyroscope; with t the true angle and v = m - t::

    e_k = eta (e_(k-1) + w_k dt - (t_k - t_(k-1))) + (1 - eta) v_k,    e_0 = v_0
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.signal import lfilter

from hostkit.attitude import pitch_from_up, roll_from_up, wrap_rad
from hostkit.recordings.recording import Vector
from hostkit.records import Axis, read_only

BODY_AXIS: dict[Axis, int] = {"roll": 0, "pitch": 1}
"""Body axis whose rate the filter of an angle integrates."""

ANGLE: dict[Axis, Callable[[Vector], Vector]] = {"roll": roll_from_up, "pitch": pitch_from_up}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class AxisMotion:
    """One angle of a recording, laid out for the error forms above.

    Attributes
    ----------
    drive
        ``w_k dt - (t_k - t_(k-1))``, rad, shape ``(N,)``; 0 at the first sample.
    start
        v, rad, shape ``(N,)``.
    coupling
        c, rad, shape ``(N,)``; 0 at the first sample.
    """

    drive: Vector
    start: Vector
    coupling: Vector

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for array in (self.drive, self.start, self.coupling):
            read_only(array)

    def neglect_rad(self, eta: float) -> Vector:
        """Return the error that the neglected rates make, shape ``(N,)``."""
        return np.asarray(lfilter([eta], [1.0, -eta], self.coupling))

    def error_rad(self, eta: float) -> Vector:
        """Return the whole error of the filter, shape ``(N,)``.

        It is that of the filter itself as long as no innovation exceeds half a turn.
        """
        source = eta * self.drive + (1.0 - eta) * self.start
        source[0] = self.start[0]
        return np.asarray(lfilter([1.0], [1.0, -eta], source))

    def wrapped_error_rad(self, eta: float) -> Vector:
        """Return the whole error with every innovation wrapped, as the filter does, ``(N,)``."""
        error = self.error_rad(eta)
        if float(np.abs(self.start - error).max()) < eta * np.pi:
            return error
        value, half, turn = float(self.start[0]), math.pi, 2.0 * math.pi
        values = [value]
        pairs = zip(self.drive[1:].tolist(), self.start[1:].tolist(), strict=True)
        for drive, start in pairs:
            value += drive
            value += (1.0 - eta) * ((start - value + half) % turn - half)
            values.append(value)
        return np.array(values)


def axis_motions(
    axes: tuple[Axis, ...], *, up: Vector, rate_rad_s: Vector, force_m_s2: Vector, period_s: float
) -> tuple[AxisMotion, ...]:
    """Lay out angles.

    Parameters
    ----------
    axes
        Which angles.
    up
        True or estimated up direction, body axes, shape ``(N, 3)``.
    rate_rad_s, force_m_s2
        Measured values without bias, body axes, each of shape ``(N, 3)``.
    period_s
        Sample period of the filter.
    """
    turn = rate_rad_s * period_s
    ahead = np.concatenate((up[:1], _turned(up[:-1], turn[1:])))
    return tuple(
        _axis_motion(ANGLE[axis], up, ahead, turn[:, BODY_AXIS[axis]], force_m_s2) for axis in axes
    )


def _axis_motion(
    angle: Callable[[Vector], Vector], up: Vector, ahead: Vector, step: Vector, force: Vector
) -> AxisMotion:
    """Lay out one angle; `ahead` is where the rates alone would turn the up before."""
    true = angle(up)
    before = np.concatenate((true[:1], true[:-1]))
    drive = step - wrap_rad(true - before)
    coupling = step - wrap_rad(angle(ahead) - before)
    drive[0] = coupling[0] = 0.0
    return AxisMotion(drive=drive, start=wrap_rad(angle(force) - true), coupling=coupling)


def _turned(up: Vector, turn_rad: Vector) -> Vector:
    """Return up directions in the axes of a body after it has turned (Rodrigues' formula)."""
    angle = np.linalg.norm(turn_rad, axis=1)[:, None]
    sine, versine = np.sinc(angle / np.pi), 0.5 * np.sinc(0.5 * angle / np.pi) ** 2
    along = np.sum(up * turn_rad, axis=1)[:, None]
    turned: Vector = up * np.cos(angle) + np.cross(up, turn_rad) * sine + turn_rad * versine * along
    return turned
