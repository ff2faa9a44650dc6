"""Running a board program as a child process: never for ever, and never left behind."""

import contextlib
import os
import selectors
import signal
import subprocess
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import IO

from hostkit.emulation.board import Progress, Receive, Send, Stop, nothing_received
from hostkit.errors import EmulationError

CHUNK_BYTES = 65536
POLL_S = 0.01
GRACE_S = 2.0
"""How long a child may take to end after it was asked to."""
REASON_LINES = 3
PROGRESS_WORD = "progress "


def collect(command: Sequence[str], *, timeout_s: float, progress: Progress | None) -> bytes:
    """Run a program to its end and return what it wrote to standard output.

    Lines ``progress N`` on its standard error are passed to `progress`.

    Raises
    ------
    EmulationError
        If it fails, naming the last lines it said, or takes longer than `timeout_s`.
    """
    pieces: list[bytes] = []
    deadline = time.monotonic() + timeout_s
    with _child(command) as (child, said):
        heard = _Progress(said, progress)
        for piece in _output(child):
            pieces.append(piece)
            heard.tell()
            if time.monotonic() > deadline:
                raise EmulationError(f"{_name(command)} did not end within {timeout_s:.0f} s")
        _require_success(child, command, said)
        heard.tell()
    return b"".join(pieces)


def stream(
    command: Sequence[str], send: Send, stop: Stop, receive: Receive = nothing_received
) -> None:
    """Run a program, hand on what it writes and give it what comes, until `stop` says so.

    Raises
    ------
    EmulationError
        If it ends by itself, naming the last lines it said.
    """
    with _child(command, stdin=subprocess.PIPE) as (child, said):
        assert child.stdin is not None
        os.set_blocking(child.stdin.fileno(), False)
        for piece in _output(child):
            if stop():
                return
            if piece:
                send(piece)
            _give(child.stdin, receive())
        _require_success(child, command, said)
        raise EmulationError(f"{_name(command)} ended although it was to go on")


def _give(stdin: IO[bytes], data: bytes) -> None:
    """Write to a program; what it does not take in time is lost, as on a wire."""
    if data:
        with contextlib.suppress(BlockingIOError, BrokenPipeError):
            os.write(stdin.fileno(), data)


def reason(text: str) -> str:
    """Return the last lines of what a program said, as one line."""
    lines = [line.strip() for line in text.splitlines()]
    kept = [line for line in lines if line and not line.startswith(PROGRESS_WORD)]
    return " | ".join(kept[-REASON_LINES:]) or "it gave no reason"


@contextlib.contextmanager
def _child(
    command: Sequence[str], *, stdin: int = subprocess.DEVNULL
) -> Iterator[tuple[subprocess.Popen[bytes], IO[bytes]]]:
    """Start a program in its own session; end it, and all it started, whatever happens."""
    with tempfile.TemporaryFile() as said:
        try:
            child = subprocess.Popen(
                command,
                stdin=stdin,
                stdout=subprocess.PIPE,
                stderr=said,
                start_new_session=True,
            )
        except OSError as error:
            raise EmulationError(f"{command[0]} cannot be started: {error.strerror}") from error
        try:
            yield child, said
        finally:
            _end(child)


def _end(child: subprocess.Popen[bytes]) -> None:
    assert child.stdout is not None
    child.stdout.close()
    if child.stdin is not None:
        child.stdin.close()
    if child.poll() is None:
        child.terminate()
        try:
            child.wait(GRACE_S)
        except subprocess.TimeoutExpired:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(child.pid, signal.SIGKILL)
            child.wait()


def _output(child: subprocess.Popen[bytes]) -> Iterator[bytes]:
    """Yield what a program writes until it closes its output; nothing now and then meanwhile."""
    assert child.stdout is not None
    with selectors.DefaultSelector() as selector:
        selector.register(child.stdout, selectors.EVENT_READ)
        while True:
            if not selector.select(POLL_S):
                yield b""
                continue
            piece = os.read(child.stdout.fileno(), CHUNK_BYTES)
            if not piece:
                return
            yield piece


def _require_success(
    child: subprocess.Popen[bytes], command: Sequence[str], said: IO[bytes]
) -> None:
    try:
        code = child.wait(GRACE_S)
    except subprocess.TimeoutExpired:
        raise EmulationError(f"{_name(command)} closed its output and did not end") from None
    if code != 0:
        said.seek(0)
        text = said.read().decode("utf-8", errors="replace")
        how = f"was ended by signal {-code}" if code < 0 else f"failed with exit code {code}"
        raise EmulationError(f"{_name(command)} {how}: {reason(text)}")


def _name(command: Sequence[str]) -> str:
    """Return the program, or the script that an interpreter runs, for messages."""
    script = [Path(part).name for part in command[:2] if Path(part).suffix == ".mjs"]
    return script[0] if script else Path(command[0]).name


class _Progress:
    """Follows the ``progress N`` lines in a program's standard error."""

    def __init__(self, said: IO[bytes], progress: Progress | None) -> None:
        self._said = said
        self._progress = progress
        self._told = -1

    def tell(self) -> None:
        if self._progress is None:
            return
        text = os.pread(self._said.fileno(), os.fstat(self._said.fileno()).st_size, 0)
        lines = text.decode("utf-8", "replace").splitlines(keepends=True)
        done = [int(x.split()[1]) for x in lines if x.startswith(PROGRESS_WORD) and x[-1] == "\n"]
        if done and done[-1] != self._told:
            self._told = done[-1]
            self._progress(done[-1])
