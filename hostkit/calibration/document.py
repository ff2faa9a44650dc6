"""A calibration as plain JSON values."""

from typing import Any

import numpy as np

from hostkit.calibration.calibrate import Calibration, rms
from hostkit.calibration.worth import halves, left_out_rms_m_s2, tilt_worth
from hostkit.provenance import TERM_UNITS
from hostkit.recordings.recording import Vector
from hostkit.units import DEG_PER_RAD


def to_document(calibration: Calibration) -> dict[str, Any]:
    """Return what was found, in the units that the names of the keys end with.

    docs/calibration.md says what each key means.
    """
    temperature = calibration.temperature
    return {
        "gravity_m_s2": calibration.gravity_m_s2,
        "temperature_c": None
        if temperature is None
        else {
            "mean": temperature.mean_c,
            "lowest": temperature.lowest_c,
            "highest": temperature.highest_c,
        },
        "recordings": [recording.name for recording in calibration.recordings],
        "terms": [
            {
                "name": term.name,
                "value": term.value,
                "standard_error": term.standard_error,
                "unit": TERM_UNITS[term.kind],
            }
            for term in calibration.terms
        ],
        "accelerometer": _accelerometer(calibration),
        "gyroscope": _gyroscope(calibration),
        "poses": _poses(calibration),
    }


def _accelerometer(calibration: Calibration) -> dict[str, Any]:
    accel, gravity = calibration.accel, calibration.gravity_m_s2
    used = accel.used
    document: dict[str, Any] = {
        "determined": accel.determined,
        "missing": list(calibration.missing),
        "poses": len(used),
        "poses_used": int(np.count_nonzero(used)),
        "before_rms_m_s2": rms(accel.before_m_s2[used]),
    }
    if not accel.determined:
        return document
    worth = tilt_worth(accel, gravity)
    apart = halves(calibration.force_m_s2[used], gravity)
    return document | {
        "condition": accel.condition,
        "after_rms_m_s2": rms(accel.after_m_s2[used]),
        "after_with_skew_rms_m_s2": rms(accel.model_m_s2[used]),
        "left_out_rms_m_s2": left_out_rms_m_s2(accel, calibration.force_m_s2, gravity),
        "tilt_before_rms_deg": worth.before_rms_rad * DEG_PER_RAD,
        "tilt_before_max_deg": worth.before_max_rad * DEG_PER_RAD,
        "tilt_after_rms_deg": worth.after_rms_rad * DEG_PER_RAD,
        "skew_deg": _list(2.0 * DEG_PER_RAD * accel.skew_rad),
        "skew_error_deg": _list(2.0 * DEG_PER_RAD * accel.skew_error_rad),
        "halves": None
        if apart is None
        else {"offset_m_s2": _list(apart.offset_m_s2), "scale": _list(apart.scale)},
    }


def _gyroscope(calibration: Calibration) -> dict[str, Any]:
    gyro = calibration.gyro
    return {
        "scale_determined": [bool(flag) for flag in gyro.determined],
        "scale_error": _list(gyro.scale_error),
        "turns": len(gyro.used),
        "turns_used": int(np.count_nonzero(gyro.used)),
        "before_rms_deg": rms(gyro.before_rad[gyro.used]) * DEG_PER_RAD,
        "after_rms_deg": rms(gyro.after_rad[gyro.used]) * DEG_PER_RAD,
        "after_with_cross_rms_deg": rms(gyro.model_rad[gyro.used]) * DEG_PER_RAD,
        "cross": _list(gyro.cross),
    }


def _poses(calibration: Calibration) -> list[dict[str, Any]]:
    accel = calibration.accel
    return [
        {
            "recording": calibration.recordings[pose.recording].name,
            "begin_s": pose.begin_s,
            "duration_s": pose.duration_s,
            "force_m_s2": _list(pose.force_m_s2),
            "rate_deg_s": _list(DEG_PER_RAD * pose.rate_rad_s),
            "before_m_s2": float(accel.before_m_s2[i]),
            "after_m_s2": float(accel.after_m_s2[i]) if accel.determined else None,
            "used": bool(accel.used[i]),
        }
        for i, pose in enumerate(calibration.poses)
    ]


def _list(values: Vector) -> list[float]:
    found: list[float] = values.tolist()
    return found
