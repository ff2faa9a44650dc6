"""The monitor: a live session with a verdict."""

from hostkit.monitor.parts import SessionOptions
from hostkit.monitor.result import SessionResult
from hostkit.monitor.session import Session

__all__ = ["Session", "SessionOptions", "SessionResult"]
