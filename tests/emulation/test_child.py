import sys
import time

import pytest

from hostkit.emulation import child
from hostkit.emulation.child import collect, stream
from hostkit.errors import EmulationError


def python(program: str) -> list[str]:
    return [sys.executable, "-c", program]


def test_collects_everything_and_tells_progress() -> None:
    progress: list[int] = []
    program = (
        "import sys, time\n"
        "for k in range(3):\n"
        "    sys.stdout.buffer.write(bytes([k]) * 100_000)\n"
        "    sys.stderr.write(f'progress {k}\\n'); sys.stderr.flush()\n"
        "    time.sleep(0.2)\n"
    )
    data = collect(python(program), timeout_s=20.0, progress=progress.append)
    assert data == bytes(100_000) + b"\1" * 100_000 + b"\2" * 100_000
    assert progress == sorted(set(progress))
    assert progress[-1] == 2


def test_a_failure_is_told_by_its_last_lines() -> None:
    program = "import sys; print('progress 3\\nfirst\\nsecond', file=sys.stderr); sys.exit(7)"
    with pytest.raises(EmulationError, match=r"failed with exit code 7: first \| second$"):
        collect(python(program), timeout_s=20.0, progress=None)


def test_a_signal_is_told() -> None:
    program = "import os, signal; os.kill(os.getpid(), signal.SIGKILL)"
    with pytest.raises(EmulationError, match="was ended by signal 9: it gave no reason"):
        collect(python(program), timeout_s=20.0, progress=None)


def test_a_program_that_hangs_is_ended() -> None:
    began = time.monotonic()
    with pytest.raises(EmulationError, match="did not end within 0 s"):
        collect(python("import time; time.sleep(60)"), timeout_s=0.3, progress=None)
    assert time.monotonic() - began < 10.0


def test_a_program_that_ignores_sigterm_is_killed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(child, "GRACE_S", 0.3)
    program = (
        "import signal, sys, time; signal.signal(signal.SIGTERM, signal.SIG_IGN);"
        "sys.stdout.write('x'); sys.stdout.flush(); time.sleep(60)"
    )
    got: list[bytes] = []
    began = time.monotonic()
    stream(python(program), got.append, lambda: bool(got))
    assert time.monotonic() - began < 10.0


def test_a_stream_that_ends_by_itself_is_an_error() -> None:
    with pytest.raises(EmulationError, match="ended although it was to go on"):
        stream(python("print('x')"), lambda _: None, lambda: False)


def test_a_silent_stream_can_be_stopped() -> None:
    deadline = time.monotonic() + 0.3
    stream(
        python("import time; time.sleep(60)"), lambda _: None, lambda: time.monotonic() > deadline
    )
    assert time.monotonic() - deadline < 5.0


def test_a_missing_program_is_named() -> None:
    with pytest.raises(EmulationError, match="no-such-program cannot be started"):
        collect(["no-such-program"], timeout_s=1.0, progress=None)
