"""Carrying out what views ask of a session, in its own thread."""

from collections.abc import Callable

from hostkit.errors import HostkitError
from hostkit.link.ports.lease import LeasablePort
from hostkit.monitor.parts import Parts


class SessionRequests:
    """Does what was asked for; what cannot be done becomes a notice.

    Parameters
    ----------
    parts
        The session.
    on_restart
        Called when figures begin anew.
    """

    def __init__(self, parts: Parts, on_restart: Callable[[], None]) -> None:
        self._parts, self._restarted = parts, on_restart

    def on_parameter(self, name: str, value: float) -> None:
        """Ask the device to use a value."""
        self._parts.conversation.set_parameter(name, value)

    def on_revert(self) -> None:
        """Ask the device for the design's values."""
        self._parts.conversation.revert()

    def on_command(self, name: str) -> None:
        """Send a command."""
        self._parts.conversation.command(name)

    def on_start_recording(self, name: str) -> None:
        """Begin a file."""
        self._parts.recordings.start(name)

    def on_stop_recording(self) -> None:
        """Finish it."""
        self._parts.recordings.stop()

    def on_port(self, take: bool) -> None:
        """Release the port or take it again."""
        port = self._parts.transport
        if not isinstance(port, LeasablePort):
            self._parts.notices.add("error", "this port cannot be released")
            return
        try:
            port.take() if take else port.release()
        except HostkitError as error:
            self._parts.notices.add("error", str(error))

    def on_restart(self) -> None:
        """Judge anew."""
        self._parts.judge.restart()
        self._parts.notices.add("info", "the verdict begins anew")
        self._restarted()

    def on_pause(self, paused: bool) -> None:
        """Hold the replay."""
        if self._parts.replay is not None:
            self._parts.replay.pause(paused)

    def on_seek(self, position_s: float) -> None:
        """Replay from elsewhere."""
        if self._parts.replay is not None:
            self._parts.replay.seek(position_s)

    def on_speed(self, speed: float | None) -> None:
        """Replay at another speed."""
        if self._parts.replay is not None:
            self._parts.replay.set_speed(speed)
