"""A device trace held against the integer and the float model of its design."""

from hostkit.validation.checks import Check, checks
from hostkit.validation.histogram import Histogram, LogHistogram
from hostkit.validation.judged import Judged
from hostkit.validation.retuning import device_parameters
from hostkit.validation.thresholds import (
    DEFAULT_MAX_LOST_SHARE,
    DEFAULT_MAX_RMS_DEG,
    Thresholds,
)
from hostkit.validation.validator import Validator

__all__ = [
    "DEFAULT_MAX_LOST_SHARE",
    "DEFAULT_MAX_RMS_DEG",
    "Check",
    "Histogram",
    "Judged",
    "LogHistogram",
    "Thresholds",
    "Validator",
    "checks",
    "device_parameters",
]
