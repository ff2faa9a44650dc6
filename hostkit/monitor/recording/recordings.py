"""The files that a session writes, and what became of them."""

import contextlib
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Protocol

from hostkit.errors import HostkitError
from hostkit.link.frames.decoder import Frame
from hostkit.link.logs.tlog import TlogWriter
from hostkit.monitor.notices import Notices
from hostkit.monitor.snapshot import RecordingState

SUFFIXES = (".tlog", ".csv", ".npz")
LONGEST_NAME = 100
FORBIDDEN = frozenset('/\\:*?"<>|')


class Recorder(Protocol):
    """Takes every frame that was received."""

    @property
    def name(self) -> str:
        """Name of the file, without its folder."""

    @property
    def frames(self) -> int:
        """How many frames are in it."""

    @property
    def written_bytes(self) -> int:
        """How many bytes are in it."""

    @property
    def left(self) -> Path | None:
        """Where an unfinished recording of that name was moved; None if there was none."""

    def add(self, epoch_us: int, frames: Sequence[Frame]) -> None:
        """Keep some frames; the clock of their arrivals was 0 at `epoch_us`, us since 1970."""

    def close(self) -> None:
        """Finish the file."""


def require_name(name: str) -> None:
    """Refuse a name for a new recording that could leave its folder, or says no form.

    Raises
    ------
    HostkitError
        If it is not one plain component of a path that ends in .tlog, .csv or .npz.
    """
    plain = name.isprintable() and not name.startswith(".") and not FORBIDDEN.intersection(name)
    if not plain or not 0 < len(name) <= LONGEST_NAME:
        raise HostkitError(
            f"{name!r:.120} is no name for a recording: a plain file name of at most "
            f"{LONGEST_NAME} characters, without a folder"
        )
    if Path(name).suffix.lower() not in SUFFIXES:
        raise HostkitError(f"{name!r} ends in none of: {', '.join(SUFFIXES)}")


class Recordings:
    """The recordings of a session; one that fails is closed, told of, and the others go on.

    Parameters
    ----------
    recorders
        Those that are open already.
    folder, opener
        Where new ones go, and what opens them.

    Attributes
    ----------
    problems
        Why recordings ended early.
    """

    def __init__(
        self,
        recorders: Sequence[Recorder],
        notices: Notices,
        *,
        folder: Path = Path(),
        opener: Callable[[Path], Recorder] = TlogWriter,
    ) -> None:
        self._open = list(recorders)
        self._folder, self._opener, self._notices = folder, opener, notices
        self._shown = self._open[-1] if self._open else None
        self._by_name: Recorder | None = None
        self._error = ""
        self.problems: list[str] = []

    @property
    def active(self) -> bool:
        """Whether anything is being written."""
        return bool(self._open)

    def check(self, name: str) -> None:
        """Refuse a name that is not plain, or that is taken.

        Raises
        ------
        HostkitError
            With what a name must be.
        """
        require_name(name)
        if (self._folder / name).exists():
            raise HostkitError(f"{name} is there already; a recording goes to a new file")

    def start(self, name: str) -> None:
        """Begin a file of the folder."""
        try:
            self.check(name)
            recorder = self._opener(self._folder / name)
        except HostkitError as error:
            self._notices.add("error", f"no recording: {error}")
            return
        self._open.append(recorder)
        self._shown = self._by_name = recorder
        self._error = ""
        if recorder.left is not None:
            self._notices.add("warning", f"an unfinished recording is now {recorder.left.name}")
        self._notices.add("info", f"recording to {name}")

    def stop(self) -> None:
        """Finish the recording that is shown."""
        recorder = self._shown
        if recorder is None or recorder not in self._open:
            return
        self._open.remove(recorder)
        if self._close(recorder):
            self._notices.add("info", f"{recorder.name} is complete: {recorder.frames} frames")

    def add(self, epoch_us: int, frames: Sequence[Frame]) -> None:
        """Give frames to every recording."""
        for recorder in tuple(self._open) if frames else ():
            try:
                recorder.add(epoch_us, frames)
            except HostkitError as error:
                self._fail(recorder, error)

    def close(self) -> None:
        """Finish all."""
        while self._open:
            self._close(self._open.pop())

    def state(self) -> RecordingState | None:
        """Return how the latest recording stands."""
        recorder = self._shown
        if recorder is None:
            return None
        return RecordingState(
            name=recorder.name,
            active=recorder in self._open,
            frames=recorder.frames,
            written_bytes=recorder.written_bytes,
            error=self._error,
        )

    def _fail(self, recorder: Recorder, error: HostkitError) -> None:
        self._open.remove(recorder)
        text = f"recording stopped: {error}; {recorder.frames} frames are kept in {recorder.name}"
        self._error = text
        self.problems.append(text)
        self._notices.add("error", text)
        with contextlib.suppress(HostkitError):
            recorder.close()

    def _close(self, recorder: Recorder) -> bool:
        try:
            recorder.close()
        except HostkitError as error:
            self._error = str(error)
            self.problems.append(str(error))
            self._notices.add("error", str(error))
            return False
        return True
