"""Tuning: the objective, the search, and the scoring of a finished design."""

from hostkit.tuning.evaluation import QUANTITIES, Evaluation, Score, evaluate, mean_rms_rad
from hostkit.tuning.tune import (
    TuningOptions,
    TuningResult,
    headline_rms_rad,
    sensor_config,
    tune,
)

__all__ = [
    "QUANTITIES",
    "Evaluation",
    "Score",
    "TuningOptions",
    "TuningResult",
    "evaluate",
    "headline_rms_rad",
    "mean_rms_rad",
    "sensor_config",
    "tune",
]
