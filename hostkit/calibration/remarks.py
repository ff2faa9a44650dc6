"""What a person should know of a calibration before using it, one sentence each."""

import numpy as np

from hostkit.calibration.accelerometer import SCALE_ERROR_LIMIT as ACCEL_SCALE_ERROR_LIMIT
from hostkit.calibration.calibrate import Calibration, rms
from hostkit.calibration.gyroscope import SCALE_ERROR_LIMIT
from hostkit.errors import CalibrationError
from hostkit.units import DEG_PER_RAD

LOUD_M_S2 = 0.05
"""Rms of what is left of |f| - g from which on the poses do not fit one set of numbers."""
LOUD_RAD = 2.0 / DEG_PER_RAD
SKEWED_RAD = 0.5 / DEG_PER_RAD
BETWEEN_RECORDINGS_RAD_S = 0.2 / DEG_PER_RAD
CERTAIN = 3.0
"""How many standard errors make a number worth a remark."""


def require_accelerometer(calibration: Calibration) -> None:
    """Refuse a calibration whose poses do not determine the accelerometer.

    Raises
    ------
    CalibrationError
        The message names the faces that should point up in more poses.
    """
    accel = calibration.accel
    if accel.determined:
        return
    faces = " and ".join(calibration.missing)
    worst = float(accel.scale_error.max())
    error = f"{100.0 * worst:.2g} %" if np.isfinite(worst) else "without bound"
    raise CalibrationError(
        f"{len(calibration.poses)} poses do not determine the accelerometer: there are none, or "
        f"too few, with {faces}. The standard error of a scale would be {error}; the limit is "
        f"{100.0 * ACCEL_SCALE_ERROR_LIMIT:g} %. Record the sensor at rest like that too, or leave "
        "the accelerometer out with --sensors gyro"
    )


def remarks(calibration: Calibration) -> tuple[str, ...]:
    """Return the remarks on a calibration; none if there is nothing to say."""
    return (*_on_poses(calibration), *_on_accelerometer(calibration), *_on_gyroscope(calibration))


def _on_poses(calibration: Calibration) -> list[str]:
    accel = calibration.accel
    found = [
        f"the pose at {pose.begin_s:.1f} s of {calibration.recordings[pose.recording].name} is "
        f"left out: its force is off by {after:+.2f} m/s^2 from what the others say"
        for pose, used, after in zip(
            calibration.poses, accel.used.tolist(), accel.model_m_s2.tolist(), strict=True
        )
        if not used
    ]
    owner = np.array([pose.recording for pose in calibration.poses])
    rates = np.stack([pose.rate_rad_s for pose in calibration.poses])
    means = np.stack([rates[owner == i].mean(axis=0) for i in sorted(set(owner.tolist()))])
    spread = float(np.ptp(means, axis=0).max())
    if spread > BETWEEN_RECORDINGS_RAD_S:
        found.append(
            f"the bias at rest differs by up to {spread * DEG_PER_RAD:.2f} deg/s between the "
            "recordings; if they were made in one go, the sensor was not warm"
        )
    return found


def _on_accelerometer(calibration: Calibration) -> list[str]:
    accel = calibration.accel
    if not accel.determined:
        faces = ", ".join(calibration.missing)
        return [f"the accelerometer is not determined; poses are missing with {faces}"]
    found = []
    left = rms(accel.model_m_s2[accel.used])
    if left > LOUD_M_S2:
        found.append(
            f"the force at rest still differs from gravity by {left:.2f} m/s^2 rms; was the sensor "
            "quite still in each pose?"
        )
    sure = np.abs(accel.skew_rad) > CERTAIN * accel.skew_error_rad
    angle = 2.0 * float(np.abs(np.where(sure, accel.skew_rad, 0.0)).max())
    if angle > SKEWED_RAD:
        found.append(
            f"two axes of the accelerometer are {angle * DEG_PER_RAD:.1f} deg from square to each "
            f"other; no filter corrects that, and it leaves up to {0.5 * angle * DEG_PER_RAD:.1f} "
            "deg of tilt"
        )
    return found


def _on_gyroscope(calibration: Calibration) -> list[str]:
    gyro = calibration.gyro
    found = [
        f"gyro_scale_{'xyz'[axis]} is not determined by {len(calibration.turns)} turns (standard "
        f"error {100.0 * float(gyro.scale_error[axis]):.1f} %, limit {100.0 * SCALE_ERROR_LIMIT:g} "
        f"%); turn the sensor by 90 deg or more about {'xyz'[axis]} held level, from rest to rest"
        for axis in range(3)
        if not gyro.determined[axis]
    ]
    dropped = int(np.count_nonzero(~gyro.used))
    if dropped:
        found.append(f"{dropped} of {len(calibration.turns)} turns are left out: they do not fit")
    left = rms(gyro.model_rad[gyro.used])
    if gyro.determined.any() and left > LOUD_RAD:
        found.append(
            f"gravity carried through a turn is still off by {left * DEG_PER_RAD:.1f} deg rms; "
            "the times may be wrong, or the turns too fast"
        )
    return found
