"""The smoother on real recordings, with settings tuned on the same ones.

The limits are a little above what was measured. They notice a change; what can be expected of a
recording that nobody tuned on is stated with the held-out figures.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from hostkit.attitude import inclination_rad, wrap_rad
from hostkit.recordings import Recording, load
from hostkit.smoothing import SmootherSettings, smooth
from hostkit.units import DEG_PER_RAD

GOOD_SENSOR = SmootherSettings()
PENDULUM = SmootherSettings(
    gyro_noise_density_rad_s_rthz=0.154,
    gyro_bias_rad_s=0.33,
    gyro_bias_walk_rad_s_rts=4.2e-5,
    gyro_scale=0.00023,
    accel_noise_density_m_s2_rthz=0.89,
    accel_offset_m_s2=0.0002,
    accel_scale=0.0065,
    speed_m_s=0.068,
    reach_m=1.06,
)
ROBOT = SmootherSettings(
    gyro_noise_density_rad_s_rthz=0.0043,
    gyro_bias_rad_s=0.014,
    gyro_bias_walk_rad_s_rts=1.1e-4,
    gyro_scale=0.0055,
    accel_noise_density_m_s2_rthz=0.051,
    accel_offset_m_s2=0.021,
    accel_scale=0.0019,
    speed_m_s=0.0125,
    reach_m=0.22,
)
TEN_BITS = SmootherSettings(
    gyro_noise_density_rad_s_rthz=0.032,
    gyro_bias_rad_s=0.0031,
    gyro_bias_walk_rad_s_rts=1.2e-5,
    gyro_scale=0.75,
    accel_noise_density_m_s2_rthz=0.0054,
    accel_offset_m_s2=0.012,
    accel_scale=0.0023,
    speed_m_s=0.051,
    reach_m=0.5,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """A set of recordings, what the smoother believes of it, and the mean error allowed."""

    folder: str
    settings: SmootherSettings
    limit_deg: float
    plane: bool = False
    automatic: bool = False

    def __str__(self) -> str:
        return f"{self.folder}-{self.settings.lead_s * 1e3:g}ms{'-auto' * self.automatic}"


CASES = (
    Case(folder="broad", settings=replace(GOOD_SENSOR, lead_s=0.0025), limit_deg=0.34),
    Case(folder="repoimu_tstick", settings=GOOD_SENSOR, limit_deg=0.48),
    Case(folder="repoimu_pendulum", settings=PENDULUM, limit_deg=1.35, plane=True),
    Case(folder="robot_mpu", settings=ROBOT, limit_deg=2.2),
    Case(folder="upenn_arduimu", settings=TEN_BITS, limit_deg=0.95),
    Case(folder="upenn_arduimu", settings=GOOD_SENSOR, limit_deg=1.3, automatic=True),
)


CLIPPED = Case(folder="repoimu_tstick_saturated", settings=GOOD_SENSOR, limit_deg=np.inf)


def recordings(folder: Path, case: Case) -> Iterator[Recording]:
    for path in sorted((folder / case.folder).glob("*.npz")):
        yield load(path)


def error_deg(recording: Recording, case: Case) -> float:
    smoothed = smooth(
        recording.angular_rate_rad_s,
        recording.specific_force_m_s2,
        1.0 / recording.rate_hz,
        case.settings,
        automatic=case.automatic,
    )
    truth = recording.up_reference
    assert truth is not None
    keep = recording.valid & np.isfinite(truth).all(axis=1)
    up, truth = smoothed.up[keep], truth[keep]
    error = in_plane_rad(up, truth) if case.plane else inclination_rad(up, truth)
    return float(np.sqrt(np.mean(error**2))) * DEG_PER_RAD


def in_plane_rad(up: NDArray[np.float64], truth: NDArray[np.float64]) -> NDArray[np.float64]:
    """Angle about the axis of the swing, which is the sensor's z."""
    return wrap_rad(np.arctan2(up[:, 1], up[:, 0]) - np.arctan2(truth[:, 1], truth[:, 0]))


@pytest.mark.parametrize("case", CASES, ids=str)
def test_the_error_stays_below_its_limit(case: Case, data_folder: Path) -> None:
    errors = [error_deg(recording, case) for recording in recordings(data_folder, case)]
    assert len(errors) >= 5
    assert np.mean(errors) < case.limit_deg


def test_clipped_recordings_gain_from_the_full_scale(data_folder: Path) -> None:
    scale = replace(GOOD_SENSOR, gyro_full_scale_rad_s=420.0 / DEG_PER_RAD)
    told = replace(CLIPPED, settings=scale)
    for recording in recordings(data_folder, CLIPPED):
        assert error_deg(recording, told) < error_deg(recording, CLIPPED) + 0.1
