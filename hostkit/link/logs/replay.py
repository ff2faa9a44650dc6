"""A recorded tlog as a port: paced by its time stamps, with pause, speed and seek."""

from pathlib import Path

from hostkit.errors import DeviceError
from hostkit.link.clock import Clock, SystemClock
from hostkit.link.logs.parameter_history import parameter_history
from hostkit.link.logs.tlog import stamped_frames
from hostkit.link.logs.tlog_index import LONGEST_GAP_US, US_PER_S, index_tlog
from hostkit.link.ports.transport import PortState

CHUNK_BYTES = 16384
LEAST_WAIT_S = 0.02
"""Frames that come within this time are given together, as a live port does."""


class ReplayTransport:
    """The frames of a tlog when they are due.

    Parameters
    ----------
    path
        The file. One that was never finished will do: a frame cut short at its end is left out.
    speed
        How many times as fast as it was recorded; None is as fast as it is read.
    clock
        What time it is.

    Attributes
    ----------
    speed
        As above; changed by :meth:`set_speed`.
    paused
        Whether it is held.
    position_s, chunk_begin_s
        Time of the last frame given, and of the first one given with it, from the file's first.
    length_s
        Time of its last frame.
    stamps
        Of each frame that the last :meth:`read` gave: where it ends in the bytes, and its time
        stamp, us since 1970.

    Raises
    ------
    DeviceError
        If the file cannot be read, or does not begin like a tlog.
    """

    live = False

    def __init__(self, path: Path, speed: float | None = None, clock: Clock | None = None) -> None:
        self.state: PortState = "connected"
        self.epoch = 0
        self.overrun_bytes = 0
        self.stamps: list[tuple[int, int]] = []
        self.speed, self.paused = speed, False
        self._path = path
        self._clock = SystemClock() if clock is None else clock
        try:
            self._file = path.open("rb")
            self._index = index_tlog(self._file, path)
        except OSError as error:
            raise DeviceError(f"{path} cannot be read: {error.strerror}") from error
        except DeviceError:
            self._file.close()
            raise
        self.length_s = self._index.length_s
        self._parameters = parameter_history(self._file)
        self._go_to(0.0)

    def read(self, timeout_s: float) -> bytes | None:
        """Return the frames that are due, nothing if none is, None at the end."""
        self.stamps = []
        if self._next is None:
            self.state = "ended"
            return None
        if self.paused:
            self._clock.sleep(timeout_s)
            return b""
        if self.speed is None:
            return self._take(None)
        early_s = (self._next[0] - self._due_s()) / self.speed
        if early_s > 0.0:
            self._clock.sleep(min(timeout_s, max(early_s, LEAST_WAIT_S)))
        return self._take(self._due_s())

    def write(self, data: bytes) -> None:
        """Do nothing: a file listens to nobody."""

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def pause(self, paused: bool) -> None:
        """Hold the replay, or let it go on."""
        self._anchor(self.position_s)
        self.paused = paused

    def set_speed(self, speed: float | None) -> None:
        """Go on at another speed; None is as fast as it is read."""
        self._anchor(self.position_s)
        self.speed = speed

    def seek(self, position_s: float) -> None:
        """Go on elsewhere; a position outside of the file is taken to its nearer end."""
        self._go_to(min(max(position_s, 0.0), self.length_s))
        self.epoch += 1
        self.state = "connected"

    def parameters_before(self) -> list[bytes]:
        """Return the latest PARAM_VALUE frame of each parameter before the next frame."""
        position_us = self._index.first_us + int(self.position_s * US_PER_S)
        latest = {told.key: told.frame for told in self._parameters if told.time_us < position_us}
        return list(latest.values())

    def _go_to(self, position_s: float) -> None:
        mark = self._index.before(position_s)
        self._file.seek(mark.offset)
        self._frames = stamped_frames(self._file, self._path)
        self._newest_us = mark.time_us
        self._next: tuple[float, bytes] | None = None
        self._advance()
        while self._next is not None and self._next[0] < position_s:
            self._advance()
        self.position_s = self.chunk_begin_s = position_s
        self._anchor(position_s)

    def _advance(self) -> None:
        """Look at the next frame; a stamp that cannot be is taken for that of the frame before."""
        try:
            found = next(self._frames, None)
        except OSError as error:
            raise DeviceError(f"{self._path} cannot be read: {error.strerror}") from error
        if found is None:
            self._next = None
            return
        time_us, frame = found
        if abs(time_us - self._newest_us) < LONGEST_GAP_US:
            self._newest_us = time_us
        self._next = ((self._newest_us - self._index.first_us) / US_PER_S, frame)

    def _take(self, due_s: float | None) -> bytes:
        """Return the frames up to a position, a chunk of them at most."""
        frames: list[bytes] = []
        size = 0
        while self._next is not None and size < CHUNK_BYTES:
            time_s, frame = self._next
            if due_s is not None and time_s > due_s:
                break
            if not frames:
                self.chunk_begin_s = time_s
            self.position_s = time_s
            frames.append(frame)
            size += len(frame)
            self.stamps.append((size, self._newest_us))
            self._advance()
        return b"".join(frames)

    def _due_s(self) -> float:
        """Return the position that should be reached by now."""
        assert self.speed is not None
        elapsed_s = self._clock.monotonic() - self._anchored_s
        return self._anchor_position_s + elapsed_s * self.speed

    def _anchor(self, position_s: float) -> None:
        """Count time from here on."""
        self._anchored_s = self._clock.monotonic()
        self._anchor_position_s = position_s
