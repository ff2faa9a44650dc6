"""The state file of a fleet's output folder: which designs hostkit made, and with which options.

It is a line of JSON for each design, on the disk before the design is. So a design of which the
file says nothing is somebody else's, wherever a run was interrupted. A line that was cut in two is
no line: the design it was to announce was never written.
"""

import fcntl
import hashlib
import json
import os
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

from hostkit.errors import HostkitError
from hostkit.files import write_aside
from hostkit.fleet.records import SensorWish
from hostkit.tuning import TuningOptions
from hostkit.tuning.tune import versions

STATE = ".fleet-state.jsonl"
LOCK = ".fleet-lock"


class Journal:
    """The state of one output folder, held by one run at a time."""

    def __init__(self, path: Path) -> None:
        """Read the state; what is not a whole line is left out and cleared away."""
        self._path = path
        text = path.read_text(encoding="utf-8", errors="replace") if path.exists() else ""
        self._made: dict[str, dict[str, str]] = {}
        for device, digest, fingerprint in _parsed(text):
            self._made.setdefault(device, {})[digest] = fingerprint
        clean = "".join(
            _line(device, digest, fingerprint)
            for device, designs in sorted(self._made.items())
            for digest, fingerprint in designs.items()
        )
        if clean != text:
            write_aside(path, clean)

    def knows(self, device: str) -> bool:
        """Tell whether a design was ever made for a device."""
        return device in self._made

    def fingerprint(self, device: str, digest: str) -> str | None:
        """Return the fingerprint of the options of a design, or None if it was not made here."""
        return self._made.get(device, {}).get(digest)

    def add(self, device: str, digest: str, fingerprint: str) -> None:
        """Remember a design that is about to be written.

        Raises
        ------
        HostkitError
            If it cannot be written down.
        """
        if self.fingerprint(device, digest) == fingerprint:
            return
        self._made.setdefault(device, {})[digest] = fingerprint
        try:
            with self._path.open("a", encoding="utf-8") as stream:
                stream.write(_line(device, digest, fingerprint))
                stream.flush()
                os.fsync(stream.fileno())
        except OSError as error:
            reason = error.strerror or str(error)
            raise HostkitError(f"{self._path} cannot be written: {reason}") from error


@contextmanager
def open_journal(output: Path) -> Iterator[Journal]:
    """Make the output folder, keep other runs out of it, and read its state.

    Temporary files that a killed run left are removed.

    Raises
    ------
    HostkitError
        If the folder cannot be made or written, or another run is writing to it.
    """
    with ExitStack() as stack:
        try:
            output.mkdir(parents=True, exist_ok=True)
            lock = stack.enter_context((output / LOCK).open("w"))
            _hold(lock.fileno(), output)
            for left_over in output.glob(".*.json*.part"):
                left_over.unlink(missing_ok=True)
            journal = Journal(output / STATE)
        except OSError as error:
            reason = error.strerror or str(error)
            raise HostkitError(f"{output} cannot be used as output folder: {reason}") from error
        yield journal


def _hold(handle: int, output: Path) -> None:
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError as error:
        raise HostkitError(f"another run is writing to {output}; wait for its end") from error


def fingerprint(tuning: TuningOptions, wish: SensorWish) -> str:
    """Return 16 hex digits that change with every option and every version that decide a design."""
    text = repr((tuning, wish, versions()))
    return hashlib.sha256(text.encode("utf-8")).hexdigest()[:16]


def _parsed(text: str) -> Iterator[tuple[str, str, str]]:
    for line in text.splitlines(keepends=True):
        try:
            found = json.loads(line)
            entry = (found["device"], found["digest"], found["fingerprint"])
        except (ValueError, KeyError, TypeError):
            continue
        if line.endswith("\n") and all(isinstance(part, str) for part in entry):
            yield entry


def _line(device: str, digest: str, fingerprint: str) -> str:
    return json.dumps({"device": device, "digest": digest, "fingerprint": fingerprint}) + "\n"
