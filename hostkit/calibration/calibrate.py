"""The whole calibration: poses, accelerometer, turns, gyroscope, and the terms that came out."""

from dataclasses import dataclass

import numpy as np

from hostkit.calibration.accelerometer import AccelFit, fit_accelerometer
from hostkit.calibration.coverage import missing_faces
from hostkit.calibration.gyroscope import GyroFit, fit_gyroscope
from hostkit.calibration.poses import MAX_RATE_RAD_S, Pose, find_poses
from hostkit.calibration.rest_rate import rest_rate
from hostkit.calibration.turn_model import Problem
from hostkit.calibration.turns import Turn, find_turns
from hostkit.errors import CalibrationError
from hostkit.provenance import CalibrationRecord, CalibrationTerm, TermKind
from hostkit.recordings import Recording
from hostkit.recordings.recording import Vector
from hostkit.records import RecordingDigest
from hostkit.units import DEG_PER_RAD, STANDARD_GRAVITY_M_S2


@dataclass(frozen=True, slots=True, kw_only=True)
class Temperature:
    """Temperature at rest, degrees Celsius: mean over the samples, least and greatest."""

    mean_c: float
    lowest_c: float
    highest_c: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Calibration:
    """What recordings say of a sensor.

    Attributes
    ----------
    gravity_m_s2
        Magnitude of gravity that was assumed.
    poses, turns
        What was found in the recordings.
    accel, gyro
        The fits. That of the accelerometer may not be determined.
    missing
        Faces that more poses should have pointed up, best first; empty if it is.
    temperature
        At rest; None where no recording has it.
    recordings
        What it was found on.
    """

    gravity_m_s2: float
    poses: tuple[Pose, ...]
    turns: tuple[Turn, ...]
    accel: AccelFit
    gyro: GyroFit
    missing: tuple[str, ...]
    temperature: Temperature | None
    recordings: tuple[RecordingDigest, ...]

    @property
    def force_m_s2(self) -> Vector:
        """Mean reading of each pose, shape ``(P, 3)``."""
        return np.stack([pose.force_m_s2 for pose in self.poses])

    @property
    def terms(self) -> tuple[CalibrationTerm, ...]:
        """What is determined, bias and scale of the gyroscope first."""
        gyro, accel = self.gyro, self.accel
        found = list(_terms("gyro_bias", gyro.bias_rad_s, gyro.bias_error_rad_s))
        scales = _terms("gyro_scale", gyro.scale, gyro.scale_error)
        found += [term for term in scales if gyro.determined[term.axis]]
        if accel.determined:
            found += _terms("accel_offset", accel.offset_m_s2, accel.offset_error_m_s2)
            found += _terms("accel_scale", accel.scale, accel.scale_error)
        return tuple(found)


def calibrate(
    recordings: tuple[Recording, ...], *, gravity_m_s2: float = STANDARD_GRAVITY_M_S2
) -> Calibration:
    """Find what a sensor reads wrong, from recordings of it in several positions at rest.

    Parameters
    ----------
    recordings
        All of the same sensor.
    gravity_m_s2
        Magnitude of gravity where they were made.

    Raises
    ------
    CalibrationError
        If the sensor is never at rest, or what comes out is no sensor's.
    """
    poses = find_poses(recordings)
    if not poses:
        names = ", ".join(recording.name for recording in recordings)
        raise CalibrationError(
            f"the sensor is never at rest for a second in {names}; put it down, or hold it against "
            "something firm, for three seconds or more in each position; a mean rate above "
            f"{MAX_RATE_RAD_S * DEG_PER_RAD:g} deg/s is taken for a turn"
        )
    force = np.stack([pose.force_m_s2 for pose in poses])
    accel = fit_accelerometer(force, gravity_m_s2)
    turns = find_turns(recordings, poses)
    rest = rest_rate(recordings, poses)
    problem = Problem(
        recordings=recordings,
        turns=turns,
        up_before=_up(accel, tuple(turn.force_before_m_s2 for turn in turns)),
        up_after=_up(accel, tuple(turn.force_after_m_s2 for turn in turns)),
        bias_rad_s=rest.of_sample_rad_s,
    )
    gyro = fit_gyroscope(problem, rest)
    return Calibration(
        gravity_m_s2=gravity_m_s2,
        poses=poses,
        turns=turns,
        accel=accel,
        gyro=gyro,
        missing=() if accel.determined else missing_faces(force, gravity_m_s2),
        temperature=_temperature(recordings, poses),
        recordings=tuple(
            RecordingDigest(name=r.name, sha256=r.sha256, samples=len(r)) for r in recordings
        ),
    )


def to_record(calibration: Calibration) -> CalibrationRecord:
    """Return what a design remembers of a calibration."""
    accel, gyro, temperature = calibration.accel, calibration.gyro, calibration.temperature
    scaled = bool(gyro.determined.any())
    return CalibrationRecord(
        gravity_m_s2=calibration.gravity_m_s2,
        poses=int(np.count_nonzero(accel.used)),
        turns=int(np.count_nonzero(gyro.used)),
        terms=calibration.terms,
        recordings=calibration.recordings,
        temperature_c=None if temperature is None else temperature.mean_c,
        temperature_low_c=None if temperature is None else temperature.lowest_c,
        temperature_high_c=None if temperature is None else temperature.highest_c,
        force_before_m_s2=rms(accel.before_m_s2[accel.used]) if accel.determined else None,
        force_after_m_s2=rms(accel.after_m_s2[accel.used]) if accel.determined else None,
        turn_before_deg=rms(gyro.before_rad[gyro.used]) * DEG_PER_RAD if scaled else None,
        turn_after_deg=rms(gyro.after_rad[gyro.used]) * DEG_PER_RAD if scaled else None,
    )


def rms(values: Vector) -> float:
    """Return the root of the mean square; 0 of nothing."""
    return float(np.sqrt(np.mean(values**2))) if values.size else 0.0


def _terms(kind: TermKind, values: Vector, errors: Vector) -> tuple[CalibrationTerm, ...]:
    pairs = zip(values.tolist(), errors.tolist(), strict=True)
    return tuple(
        CalibrationTerm(kind=kind, axis=axis, value=value, standard_error=error)
        for axis, (value, error) in enumerate(pairs)
    )


def _up(accel: AccelFit, readings: tuple[Vector, ...]) -> Vector:
    """Return directions of gravity, unit vectors, shape ``(T, 3)``."""
    true = accel.corrected(np.asarray(readings, dtype=np.float64).reshape(-1, 3))
    unit: Vector = true / np.linalg.norm(true, axis=1, keepdims=True)
    return unit


def _temperature(recordings: tuple[Recording, ...], poses: tuple[Pose, ...]) -> Temperature | None:
    found = [
        track[pose.first : pose.last + 1]
        for pose in poses
        if (track := recordings[pose.recording].temperature_deg_c) is not None
    ]
    values = np.concatenate(found) if found else np.zeros(0)
    values = values[np.isfinite(values)]
    if not values.size:
        return None
    return Temperature(
        mean_c=float(values.mean()),
        lowest_c=float(values.min()),
        highest_c=float(values.max()),
    )
