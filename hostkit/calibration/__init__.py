"""Calibration: what a sensor reads wrong, from recordings of it at rest in several positions."""

from hostkit.calibration.accelerometer import fit_accelerometer
from hostkit.calibration.calibrate import Calibration, calibrate, rms, to_record
from hostkit.calibration.poses import find_poses
from hostkit.calibration.turn_model import Problem
from hostkit.calibration.turns import find_turns
from hostkit.calibration.worth import tilt_worth

__all__ = [
    "Calibration",
    "Problem",
    "calibrate",
    "find_poses",
    "find_turns",
    "fit_accelerometer",
    "rms",
    "tilt_worth",
    "to_record",
]
