"""Settings from the recording itself, without a reference.

The deviance of a solution (`hostkit.smoothing.likelihood`) tells settings of one recording apart,
so it is made small over a ladder for each of the deviations that differ most between sensors:
what the rate and the force lack, and the scale error of the gyroscope. A cheap sensor gives itself
away by residuals far beyond those of a good one. The others keep their value.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from hostkit.smoothing.equations import Estimate, improve
from hostkit.smoothing.likelihood import deviance
from hostkit.smoothing.preintegration import Blocks
from hostkit.smoothing.rotation import Array
from hostkit.smoothing.settings import SmootherSettings

LADDERS: dict[str, tuple[float, ...]] = {
    "gyro_noise_density_rad_s_rthz": (0.0024, 0.006, 0.015, 0.04, 0.1),
    "accel_noise_density_m_s2_rthz": (0.005, 0.025, 0.12, 0.6),
    "gyro_scale": (0.001, 0.01, 0.1, 0.7),
}
STEPS = 3
"""Steps of Gauss and Newton that a comparison takes."""
ROUNDS = 3
LEAST_GAIN = 4.0
"""By how much the deviance must fall for a move: what one more free number gains by chance."""
LEAST_GAIN_OF_BLOCK = 2.0
"""By how much of each block it must fall for other settings than the first. The model of the motion
is not exact, so small gains say nothing of the tilt: 0.9 did slight harm on good sensors, and a
10-bit sensor gains 3 to 27."""

PLANAR = 0.04
"""Share of the second axis in the turning below which a motion is planar."""
PLANAR_GYRO_SCALE = 0.0003


def is_planar(angular_rate_rad_s: Array) -> bool:
    """Return whether a motion turns about one axis only.

    Where it does, a scale error of the gyroscope looks like a tilt that goes with the swing, and
    nothing in the recording can tell the two apart.

    Parameters
    ----------
    angular_rate_rad_s
        Shape ``(N, 3)``; a constant bias does not count.
    """
    turning = angular_rate_rad_s - np.median(angular_rate_rad_s, axis=0)
    power = np.linalg.eigvalsh(turning.T @ turning)
    return bool(power[1] < PLANAR * power[2])


def held(settings: SmootherSettings, planar: bool) -> SmootherSettings:
    """Return settings that leave no constant free that the motion does not show."""
    if not planar:
        return settings
    return replace(settings, gyro_scale=min(settings.gyro_scale, PLANAR_GYRO_SCALE))


@dataclass(slots=True, kw_only=True)
class _Search:
    """Settings of one recording and their deviances, each computed once."""

    blocks: Blocks
    start: Estimate
    known: dict[SmootherSettings, float] = field(default_factory=dict)

    def cost(self, settings: SmootherSettings) -> float:
        if settings not in self.known:
            self.known[settings] = self._cost(settings)
        return self.known[settings]

    def _cost(self, settings: SmootherSettings) -> float:
        estimate = self.start
        try:
            for _ in range(STEPS):
                estimate = improve(self.blocks, settings, estimate)
            found = deviance(self.blocks, settings, estimate)
        except np.linalg.LinAlgError:
            return np.inf
        return found if np.isfinite(found) else np.inf


def chosen(
    blocks: Blocks, start: Estimate, settings: SmootherSettings, planar: bool
) -> tuple[SmootherSettings, int]:
    """Return the settings under which a recording is likeliest, and how many were compared.

    The first ones stay unless others are likelier by far, `LEAST_GAIN_OF_BLOCK`.

    Parameters
    ----------
    blocks, start
        The recording, and where the solution starts.
    settings
        Those to begin with; what no ladder names stays as it is.
    planar
        Whether the motion is planar: the gyroscope's scale error is then left out.
    """
    search = _Search(blocks=blocks, start=start)
    best = min((held(begin, planar) for begin in _begins(settings)), key=search.cost)
    for _ in range(ROUNDS):
        before = best
        for name in LADDERS:
            if not (planar and name == "gyro_scale"):
                best = _walked(search, best, name)
        if best == before:
            break
    gain = search.cost(settings) - search.cost(best)
    enough = gain > LEAST_GAIN_OF_BLOCK * len(blocks.duration_s)
    return best if enough else settings, len(search.known)


def _begins(settings: SmootherSettings) -> Iterator[SmootherSettings]:
    """Yield far apart places to start from: the deviance has more than one valley."""
    yield settings
    yield replace(settings, gyro_noise_density_rad_s_rthz=0.04, gyro_scale=0.1)
    yield replace(settings, gyro_noise_density_rad_s_rthz=0.04, accel_noise_density_m_s2_rthz=0.6)


def _walked(search: _Search, best: SmootherSettings, name: str) -> SmootherSettings:
    """Move one deviation from rung to rung while that makes the recording likelier."""
    while True:
        near = min(_neighbours(best, name), key=search.cost)
        if not search.cost(near) < search.cost(best) - LEAST_GAIN:
            return best
        best = near


def _neighbours(settings: SmootherSettings, name: str) -> Iterator[SmootherSettings]:
    """Yield settings with the next smaller and the next larger rung."""
    now = getattr(settings, name)
    smaller = [rung for rung in LADDERS[name] if rung < now]
    larger = [rung for rung in LADDERS[name] if rung > now]
    for rung in (*smaller[-1:], *larger[:1]):
        yield replace(settings, **{name: rung})
