"""The monitor: a live session with a verdict."""

from hostkit.monitor.session import Session, SessionOptions, SessionResult

__all__ = ["Session", "SessionOptions", "SessionResult"]
