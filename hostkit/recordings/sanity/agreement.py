"""Whether gyroscope and accelerometer tell of the same motion: in sign, per axis, and in unit.

In sensor axes the up direction turns as ``d(up)/dt = up x rate`` (strapdown kinematics, with the
convention of `hostkit.attitude`). Both sides are known: up from the specific force, the rate from
the gyroscope. Integrated over windows, the left side is regressed on the three columns
``up x e_i rate_i``, whose weights are +1 for a sensor that is right, -1 for an axis of the wrong
sign and pi/180 for a gyroscope in deg/s. Three more columns, ``up x e_i``, take a constant bias.
"""

from dataclasses import dataclass
from itertools import product

import numpy as np

from hostkit.recordings.recording import Recording, Vector
from hostkit.units import STANDARD_GRAVITY_M_S2

WINDOW_S = 0.25
"""Both sides are averaged twice over this time, a low-pass of about 1.5 Hz."""
FORCE_TOLERANCE = 0.3
"""Samples whose force differs from gravity by more, relatively, say little of up."""
MIN_SHARE = 0.8
"""Share of samples within the tolerance that a window needs."""
MIN_WINDOWS = 10
GAP_STEPS = 2.5
MIN_GAP_S = 0.1
"""Steps beyond both are left out; shorter ones are integrated over, in bursts too."""
FLIPPED_RATIO = 2.0
"""The best fit with the axis as it is must leave this much more of the square error."""
UNUSED_RATIO = 1.3
"""The best fit without the axis must leave this much more of the square error."""
MIN_EXPLAINED = 0.5
"""Share of the square of d(up)/dt that the rate must explain before its unit is judged."""

Signs = tuple[int, int, int]


@dataclass(frozen=True, slots=True, kw_only=True)
class Agreement:
    """What the regression says.

    Attributes
    ----------
    judged
        Per axis: whether there was enough motion to tell the sign.
    flipped
        Per axis: whether the sign is wrong; False where it was not judged.
    scale
        What the angular rate must be multiplied by to agree with d(up)/dt: 1 if the units are
        right, pi/180 for deg/s. None if there was not enough motion.
    explained
        Share of the square of d(up)/dt that the rate explains with that scale, 0 to 1.
    """

    judged: tuple[bool, bool, bool]
    flipped: tuple[bool, bool, bool]
    scale: float | None
    explained: float = 0.0


def agreement(recording: Recording) -> Agreement:
    """Compare gyroscope and accelerometer of a recording whose times rise and values are finite."""
    problem = _regression(recording)
    if problem is None:
        return Agreement(judged=(False,) * 3, flipped=(False,) * 3, scale=None)
    columns, turned = problem
    errors = _errors(columns, turned)
    flipped, upright = (_axes(errors, sign) for sign in (-1, 1))
    judged = tuple(f or u for f, u in zip(flipped, upright, strict=True))
    explained, scale = _scale(columns, turned)
    return Agreement(
        judged=(judged[0], judged[1], judged[2]),
        flipped=flipped,
        scale=scale if explained > MIN_EXPLAINED else None,
        explained=explained,
    )


def _regression(recording: Recording) -> tuple[Vector, Vector] | None:
    """Return the columns, shape ``(3 W, 3)``, and the turn of up, ``(3 W,)``, without bias."""
    force = recording.specific_force_m_s2
    norm = np.linalg.norm(force, axis=1)
    trusted = np.abs(norm / STANDARD_GRAVITY_M_S2 - 1.0) < FORCE_TOLERANCE
    steps_s = np.diff(recording.time_s)
    whole = steps_s <= max(MIN_GAP_S, GAP_STEPS * float(np.median(steps_s)))
    width = max(1, round(WINDOW_S / float(steps_s[whole].mean())))
    if len(recording) < 4 * width or not trusted.any():
        return None
    up = force / np.where(norm > 0.0, norm, 1.0)[:, None]
    crosses = np.stack([np.cross(up, axis) for axis in np.eye(3)], axis=2)
    both = np.concatenate((crosses * recording.angular_rate_rad_s[:, None, :], crosses), axis=2)
    usable = trusted[1:] & trusted[:-1] & whole
    kept = _averaged(usable.astype(np.float64), width) > MIN_SHARE
    turned = _averaged(np.diff(up, axis=0), width)[kept].reshape(-1)
    turning = 0.5 * (both[1:] + both[:-1]) * steps_s[:, None, None]
    columns = _averaged(turning, width)[kept].reshape(-1, 6)
    if len(turned) < 3 * MIN_WINDOWS:
        return None
    basis, _ = np.linalg.qr(columns[:, 3:])
    return (
        columns[:, :3] - basis @ (basis.T @ columns[:, :3]),
        turned - basis @ (basis.T @ turned),
    )


def _averaged(values: Vector, width: int) -> Vector:
    """Average twice over `width` samples along the first axis and keep every `width`-th."""
    return _boxcar(_boxcar(values, width), width)[::width]


def _boxcar(values: Vector, width: int) -> Vector:
    total = np.cumsum(np.concatenate((np.zeros_like(values[:1]), values)), axis=0)
    mean: Vector = (total[width:] - total[:-width]) / width
    return mean


def _errors(columns: Vector, turned: Vector) -> dict[Signs, float]:
    """Return the square error for every choice of +1, -1 or 0 as the weight of each axis."""
    gram, pull, start = columns.T @ columns, columns.T @ turned, float(turned @ turned)
    floor = 1e-12 * start + 1e-300
    errors = {}
    for x, y, z in product((1, -1, 0), repeat=3):
        weight = np.array((x, y, z), dtype=np.float64)
        error = start - 2.0 * float(weight @ pull) + float(weight @ gram @ weight)
        errors[x, y, z] = max(error, floor)
    return errors


def _axes(errors: dict[Signs, float], sign: int) -> tuple[bool, bool, bool]:
    """Return, per axis, whether `sign` explains the motion clearly better than the others."""

    def least(axis: int, choice: int) -> float:
        return min(error for signs, error in errors.items() if signs[axis] == choice)

    def clear(axis: int) -> bool:
        best = least(axis, sign)
        opposite, unused = least(axis, -sign), least(axis, 0)
        return opposite > FLIPPED_RATIO * best and unused > UNUSED_RATIO * best

    return clear(0), clear(1), clear(2)


def _scale(columns: Vector, turned: Vector) -> tuple[float, float]:
    """Return the share explained by the choice of signs that explains most, and its factor."""
    found: list[tuple[float, float]] = []
    for signs in product((1.0, -1.0), repeat=3):
        column = columns @ np.array(signs)
        power, pull = float(column @ column), float(column @ turned)
        if power > 0.0 and pull > 0.0:
            found.append((pull**2 / (power * float(turned @ turned)), pull / power))
    return max(found, default=(0.0, 0.0))
