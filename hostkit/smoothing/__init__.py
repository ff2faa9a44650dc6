"""Smoothing: the tilt of a whole recording at once, with what comes later as well as before."""

from hostkit.smoothing.settings import SmootherSettings
from hostkit.smoothing.smoother import Smoothed, smooth

__all__ = ["Smoothed", "SmootherSettings", "smooth"]
