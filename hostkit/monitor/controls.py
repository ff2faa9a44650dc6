"""What other threads may ask of a session: checked at once, carried out by the session."""

import math
from collections.abc import Callable

from hostkit.errors import HostkitError
from hostkit.monitor.inbox import Inbox
from hostkit.monitor.requests import SessionRequests
from hostkit.monitor.snapshot import ParameterState, SessionInfo, Snapshot

COMMANDS = ("calibrate", "self-test", "store", "defaults", "reboot")
SPEEDS = (0.01, 1000.0)


class SessionControls:
    """The way into a session for views; nothing here waits.

    Parameters
    ----------
    requests
        What carries them out in the session's thread.
    inbox
        Where requests wait for it.
    info
        What does not change.
    latest
        Returns the latest snapshot.
    check_name
        Raises HostkitError if a recording may not have that name.
    """

    def __init__(
        self,
        requests: SessionRequests,
        inbox: Inbox,
        info: SessionInfo,
        latest: Callable[[], Snapshot],
        check_name: Callable[[str], None],
    ) -> None:
        self._do, self._inbox, self._info = requests, inbox, info
        self._latest, self._check_name = latest, check_name

    def info(self) -> SessionInfo:
        """Return what does not change."""
        return self._info

    def snapshot(self) -> Snapshot:
        """Return the latest state."""
        return self._latest()

    def set_parameter(self, name: str, value: float) -> None:
        """Ask the device to use a value."""
        self._require_live()
        parameter = self._parameter(name)
        require_in_range(parameter, value)
        self._inbox.put(lambda: self._do.on_parameter(name, value))

    def revert_parameters(self) -> None:
        """Ask the device to use the values of its design."""
        self._require_live()
        self._inbox.put(self._do.on_revert)

    def command(self, name: str) -> None:
        """Send a command to the device."""
        self._require_live()
        if name not in COMMANDS:
            raise HostkitError(f"{name!r:.40} is no command; there are: {', '.join(COMMANDS)}")
        self._inbox.put(lambda: self._do.on_command(name))

    def start_recording(self, name: str) -> None:
        """Write what comes to a new file of the session's folder."""
        self._check_name(name)
        state = self._latest().recording
        if state is not None and state.active:
            raise HostkitError(f"{state.name} is being written; stop that recording first")
        self._inbox.put(lambda: self._do.on_start_recording(name))

    def stop_recording(self) -> None:
        """Finish the file."""
        self._inbox.put(self._do.on_stop_recording)

    def release_port(self) -> None:
        """Close the port, so that another program can have it."""
        self._require_live()
        self._inbox.put(lambda: self._do.on_port(False))

    def take_port(self) -> None:
        """Open the port again."""
        self._require_live()
        self._inbox.put(lambda: self._do.on_port(True))

    def restart_verdict(self) -> None:
        """Forget the figures so far and judge anew from here."""
        self._inbox.put(self._do.on_restart)

    def pause(self, paused: bool) -> None:
        """Hold a replay, or let it go on."""
        self._require_replay()
        self._inbox.put(lambda: self._do.on_pause(paused))

    def seek(self, position_s: float) -> None:
        """Go on with a replay elsewhere."""
        self._require_replay()
        if not (math.isfinite(position_s) and position_s >= 0.0):
            raise HostkitError(f"position {position_s} s; it must be a finite number, 0 or more")
        self._inbox.put(lambda: self._do.on_seek(position_s))

    def set_speed(self, speed: float | None) -> None:
        """Replay so many times as fast as it was; None is as fast as possible."""
        self._require_replay()
        require_speed(speed)
        self._inbox.put(lambda: self._do.on_speed(speed))

    def _parameter(self, name: str) -> ParameterState:
        known = self._latest().parameters
        for parameter in known:
            if parameter.name == name:
                return parameter
        names = ", ".join(p.name for p in known) or "none so far"
        raise HostkitError(f"the device has no parameter {name!r:.40}; it has: {names}")

    def _require_live(self) -> None:
        if self._info.replay:
            raise HostkitError("a recording is replayed; there is no device to ask")

    def _require_replay(self) -> None:
        if not self._info.replay:
            raise HostkitError("a live device cannot be paused, moved or sped up; replay a file")


def require_in_range(parameter: ParameterState, value: float) -> None:
    """Refuse a value that a parameter cannot have.

    Raises
    ------
    HostkitError
        If it is not finite, or outside the limits of the parameter.
    """
    lowest, highest = parameter.lowest, parameter.highest
    low = -math.inf if lowest is None else lowest
    high = math.inf if highest is None else highest
    if not math.isfinite(value) or not low <= value <= high:
        raise HostkitError(
            f"{parameter.name} = {value}; it must be a finite number in [{low:g}, {high:g}] "
            f"{parameter.unit}".rstrip()
        )


def require_speed(speed: float | None) -> None:
    """Refuse a speed at which nothing can be replayed.

    Raises
    ------
    HostkitError
        If it is not None and outside 0.01 to 1000.
    """
    low, high = SPEEDS
    if speed is not None and not (low <= speed <= high):
        raise HostkitError(f"speed {speed}; it must be from {low:g} to {high:g}")
