"""Smoothing: the tilt of a whole recording at once, with what comes later as well as before."""

from hostkit.smoothing.known import KnownSensor, known_sensor
from hostkit.smoothing.output import as_reference, save_smoothed
from hostkit.smoothing.recording import (
    SmoothedRecording,
    SmoothingScore,
    measured_reference,
    score,
    smooth_recording,
)
from hostkit.smoothing.settings import SmootherSettings
from hostkit.smoothing.settings_file import Provenance, load_settings, save_settings
from hostkit.smoothing.smoother import Smoothed, smooth
from hostkit.smoothing.training import Trained, TrainingOptions, train

__all__ = [
    "KnownSensor",
    "Provenance",
    "Smoothed",
    "SmoothedRecording",
    "SmootherSettings",
    "SmoothingScore",
    "Trained",
    "TrainingOptions",
    "as_reference",
    "known_sensor",
    "load_settings",
    "measured_reference",
    "save_settings",
    "save_smoothed",
    "score",
    "smooth",
    "smooth_recording",
    "train",
]
