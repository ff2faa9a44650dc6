"""MAVProxy as its users run it: what is typed, and what it prints."""

import contextlib
import importlib.util
import re
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

PATIENCE_S = 60.0
MODULES = "link,param,cmdlong,calibration,misc"


def require_station() -> None:
    """Skip where MAVProxy is missing."""
    if importlib.util.find_spec("MAVProxy") is None:
        pytest.skip("MAVProxy is not installed: pip install --no-deps MAVProxy")


class GroundStation:
    """A running MAVProxy: what is typed, and what it prints."""

    def __init__(self, port: str, folder: Path) -> None:
        self.folder = folder
        command = [sys.executable, "-m", "MAVProxy.mavproxy", f"--master={port}"]
        command += ["--baudrate=500000", f"--default-modules={MODULES}"]
        command += [f"--state-basedir={folder}", f"--logfile={folder / 'link.tlog'}"]
        self._child = subprocess.Popen(
            command,
            cwd=folder,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
        )
        self.printed = ""
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        assert self._child.stdout is not None
        while piece := self._child.stdout.read(1):
            self.printed += piece

    def type(self, line: str) -> None:
        assert self._child.stdin is not None
        self._child.stdin.write(line + "\n")
        self._child.stdin.flush()

    def see(self, pattern: str, *, asking: str | None = None) -> re.Match[str]:
        """Wait until it prints a text, typing a command every other second meanwhile."""
        start, deadline = len(self.printed), time.monotonic() + PATIENCE_S
        if asking is None:
            start = 0
        while time.monotonic() < deadline:
            if asking is not None:
                self.type(asking)
            again = time.monotonic() + 2.0
            while time.monotonic() < again:
                if found := re.search(pattern, self.printed[start:]):
                    return found
                time.sleep(0.05)
        pytest.fail(f"MAVProxy did not print {pattern!r}; it printed: {self.printed[-3000:]}")

    def close(self) -> None:
        assert self._child.stdin is not None
        with contextlib.suppress(BrokenPipeError):
            self._child.stdin.close()  # `exit` alone leaves it waiting for the next line
        try:
            self._child.wait(10.0)
        except subprocess.TimeoutExpired:
            self._child.kill()
            self._child.wait()
        self._reader.join(5.0)
