"""Calibration: what a sensor reads wrong, from recordings of it at rest in several positions."""

from hostkit.calibration.accelerometer import AccelFit, fit_accelerometer
from hostkit.calibration.calibrate import Calibration, calibrate, rms, to_record
from hostkit.calibration.coverage import missing_faces
from hostkit.calibration.gyroscope import GyroFit, fit_gyroscope
from hostkit.calibration.poses import Pose, find_poses
from hostkit.calibration.turn_model import Problem, RestRate
from hostkit.calibration.turns import Turn, find_turns
from hostkit.calibration.worth import halves, left_out_rms_m_s2, tilt_worth

__all__ = [
    "AccelFit",
    "Calibration",
    "GyroFit",
    "Pose",
    "Problem",
    "RestRate",
    "Turn",
    "calibrate",
    "find_poses",
    "find_turns",
    "fit_accelerometer",
    "fit_gyroscope",
    "halves",
    "left_out_rms_m_s2",
    "missing_faces",
    "rms",
    "tilt_worth",
    "to_record",
]
