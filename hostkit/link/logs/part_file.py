"""A file that is written piece by piece and has its name only when it is complete."""

import contextlib
import itertools
import os
import threading
from collections.abc import Callable, Sequence
from pathlib import Path

from hostkit.errors import HostkitError

try:
    import fcntl
# A system without POSIX locks; mypy takes no None for a module.
except ImportError:
    fcntl = None  # type: ignore[assignment]

SYNC_EVERY_S = 1.0
"""How much of the latest a loss of power may cost."""

Write = Callable[[int, bytes], int]


class PartFile:
    """A file called ``NAME.part`` until it is closed; every piece given is in it at once.

    Pieces are handed to the system as they come, so that a killed program loses none, and are
    brought to the disk once a second by a thread of its own, so that a slow disk holds nobody up.
    What is left of a recording of that name that was never finished is not written over: it is
    moved aside.

    Parameters
    ----------
    path
        Name of the complete file.
    kind
        Suffix that says what form unfinished files have.
    write
        Writes bytes to a file descriptor and returns how many.

    Attributes
    ----------
    left
        Where an unfinished file of that name was moved; None if there was none.
    written_bytes
        Bytes in the file.

    Raises
    ------
    HostkitError
        If the file cannot be written, or another program is writing it.
    """

    def __init__(self, path: Path, *, kind: str, write: Write = os.write) -> None:
        if path.exists() and not path.is_file():
            raise HostkitError(f"{path} is no file; a recording goes to a file of its own")
        self.path = path
        self.part = self.name_of_part(path)
        self.written_bytes = 0
        self.left: Path | None = None
        self._write = write
        self._file = self._open()
        if os.fstat(self._file).st_size:
            self.left = _unused(path, kind)
            self.part.rename(self.left)
            os.close(self._file)
            self._file = self._open()
        self._closing = threading.Event()
        self._sync_error: OSError | None = None
        self._thread = threading.Thread(target=self._keep_in_sync, daemon=True)
        self._thread.start()

    @staticmethod
    def name_of_part(path: Path) -> Path:
        """Return what a file is called until it is complete."""
        return path.with_name(path.name + ".part")

    def append(self, pieces: Sequence[bytes]) -> None:
        """Append some pieces, each whole or not at all.

        Raises
        ------
        PartialWriteError
            If there is no room, or the disk fails; it says how many pieces were kept.
        """
        data = b"".join(pieces)
        done = 0
        try:
            if self._sync_error is not None:
                raise self._sync_error
            while done < len(data):
                done += self._write(self._file, data[done:] if done else data)
        except OSError as error:
            ends = tuple(itertools.accumulate(len(piece) for piece in pieces))
            kept = sum(end <= done for end in ends)
            self._cut(ends[kept - 1] if kept else 0)
            raise PartialWriteError(
                f"{self.part} cannot be written: {error.strerror}", kept=kept
            ) from error
        self.written_bytes += len(data)

    def close(self) -> None:
        """Finish the file and give it its name; closing it again does nothing.

        Raises
        ------
        HostkitError
            If what was written cannot be brought to the disk.
        """
        if self._closing.is_set():
            return
        self.shut()
        try:
            self.part.replace(self.path)
        except OSError as error:
            raise HostkitError(f"{self.path} cannot be written: {error.strerror}") from error

    def shut(self) -> None:
        """Finish the file and leave it its name of a part."""
        self._closing.set()
        self._thread.join()
        try:
            os.fsync(self._file)
        except OSError as error:
            raise HostkitError(f"{self.part} cannot be written: {error.strerror}") from error
        finally:
            os.close(self._file)

    def _open(self) -> int:
        try:
            file = os.open(self.part, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o666)
        except OSError as error:
            raise HostkitError(f"{self.part} cannot be written: {error.strerror}") from error
        if fcntl is not None:
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError:
                os.close(file)
                raise HostkitError(
                    f"{self.part} is being written by another program; choose another name"
                ) from None
        return file

    def _cut(self, kept_bytes: int) -> None:
        """Take away the piece that was cut short."""
        self.written_bytes += kept_bytes
        with contextlib.suppress(OSError):
            os.ftruncate(self._file, self.written_bytes)

    def _keep_in_sync(self) -> None:
        synced_bytes = 0
        while not self._closing.wait(SYNC_EVERY_S):
            if self.written_bytes == synced_bytes:
                continue
            synced_bytes = self.written_bytes
            try:
                os.fsync(self._file)
            except OSError as error:
                self._sync_error = error
                return


class PartialWriteError(HostkitError):
    """A disk took only some of the pieces.

    Attributes
    ----------
    kept
        How many pieces are whole in the file.
    """

    def __init__(self, message: str, *, kept: int) -> None:
        super().__init__(message)
        self.kept = kept


def _unused(path: Path, kind: str) -> Path:
    """Return a free name for what is left of a recording."""
    for number in itertools.count(1):
        found = path.with_name(f"{path.stem}.unfinished-{number}{kind}")
        if not found.exists():
            return found
    raise AssertionError("names do not run out")
