"""The monitor: a live session with a verdict."""

from hostkit.monitor.session import Session, SessionResult

__all__ = ["Session", "SessionResult"]
