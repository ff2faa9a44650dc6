"""Tuning: the objective, the search, and the scoring of a finished design."""

from hostkit.tuning.determination import Interval, Profile
from hostkit.tuning.dimension import FixedParameter, FreeName, SearchRange
from hostkit.tuning.evaluation import QUANTITIES, Evaluation, Score, evaluate, mean_rms_rad
from hostkit.tuning.options import AUTO, TuningOptions
from hostkit.tuning.retuning import HeldOut
from hostkit.tuning.sensor_choice import sensor_config
from hostkit.tuning.tune import TuningResult, headline_rms_rad, tune
from hostkit.tuning.tuners import TUNERS

__all__ = [
    "AUTO",
    "QUANTITIES",
    "TUNERS",
    "Evaluation",
    "FixedParameter",
    "FreeName",
    "HeldOut",
    "Interval",
    "Profile",
    "Score",
    "SearchRange",
    "TuningOptions",
    "TuningResult",
    "evaluate",
    "headline_rms_rad",
    "mean_rms_rad",
    "sensor_config",
    "tune",
]
