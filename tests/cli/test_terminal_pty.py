"""`hostkit monitor` on a real terminal: what it draws, and how it leaves."""

import contextlib
import fcntl
import os
import re
import select
import signal
import struct
import subprocess
import sys
import termios
import time
from pathlib import Path

import pytest
from designs import design
from device import Device

from hostkit.design_file import save_design
from hostkit.link.logs.tlog import STAMP

PATIENCE_S = 30.0
HIDE, SHOW = "\x1b[?25l", "\x1b[?25h"
COLOUR = re.compile(r"\x1b\[(?:\d+;)*(?:3\d|4\d|9\d)[;m]")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A design, and two seconds of a device that runs it."""
    path = tmp_path_factory.mktemp("terminal")
    device = Device(design())
    save_design(device.design, path / "design.json")
    frames = device.frames(200)
    stamped = (STAMP.pack(10**15 + 10_000 * k) + frame for k, frame in enumerate(frames))
    (path / "flight.tlog").write_bytes(b"".join(stamped))
    return path


class Screen:
    """hostkit with a terminal of 80 columns and 24 lines for its standard error."""

    def __init__(self, folder: Path, *arguments: str, **environment: str) -> None:
        self.drawn = ""
        self._master, slave = os.openpty()
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 80, 0, 0))
        kept = {k: v for k, v in os.environ.items() if k not in ("NO_COLOR", "COLUMNS", "LINES")}
        self._child = subprocess.Popen(
            [sys.executable, "-m", "hostkit", "monitor", "design.json", *arguments],
            cwd=folder,
            stdin=slave,
            stdout=subprocess.PIPE,
            stderr=slave,
            env={**kept, **environment},
            text=True,
        )
        os.close(slave)

    def see(self, text: str) -> None:
        deadline = time.monotonic() + PATIENCE_S
        while text not in self.drawn:
            assert self._read(deadline), f"{text!r} was not drawn, but: {self.drawn[-2000:]!r}"

    def _read(self, deadline: float) -> bool:
        left_s = deadline - time.monotonic()
        if left_s <= 0.0 or not select.select([self._master], [], [], left_s)[0]:
            return False
        with contextlib.suppress(OSError):  # the terminal of a program that has ended
            piece = os.read(self._master, 4096)
            self.drawn += piece.decode(errors="replace")
            return bool(piece)
        return False

    def interrupt(self) -> None:
        self._child.send_signal(signal.SIGINT)

    def end(self) -> tuple[int, str]:
        """Wait for its end; return exit code and standard output."""
        deadline = time.monotonic() + PATIENCE_S
        while self._read(deadline):
            pass
        out, _ = self._child.communicate(timeout=PATIENCE_S)
        os.close(self._master)
        return self._child.returncode, out


def test_a_table_is_drawn_and_results_stand_alone(folder: Path) -> None:
    screen = Screen(folder, "--port", "file:flight.tlog", "--speed", "2", TERM="xterm-256color")
    screen.see("samples/s")
    code, out = screen.end()
    assert code == 0
    assert "200 samples, 0 lost" in screen.drawn
    assert out.splitlines()[-1] == "verdict: pass"
    assert "\x1b" not in out
    assert screen.drawn.rindex(SHOW) > screen.drawn.rindex(HIDE)
    assert COLOUR.search(screen.drawn)


def test_without_colour_there_is_none(folder: Path) -> None:
    port = ("--port", "file:flight.tlog", "--speed", "2")
    screen = Screen(folder, *port, TERM="xterm-256color", NO_COLOR="1")
    code, _ = screen.end()
    assert code == 0
    assert "pass" in screen.drawn
    assert HIDE in screen.drawn
    assert COLOUR.search(screen.drawn) is None


def test_a_dumb_terminal_gets_plain_lines(folder: Path) -> None:
    screen = Screen(folder, "--port", "file:flight.tlog", "--speed", "0.5", TERM="dumb")
    code, _ = screen.end()
    assert code == 0
    assert "pass so far" in screen.drawn
    assert "\x1b" not in screen.drawn


def test_an_interrupted_table_leaves_the_terminal_as_it_was(folder: Path) -> None:
    port = ("--port", "file:flight.tlog", "--speed", "0.1")
    screen = Screen(folder, *port, TERM="xterm-256color")
    screen.see("pass so far")
    screen.interrupt()
    code, out = screen.end()
    assert code == 0
    assert "verdict: pass" in out
    assert screen.drawn.rindex(SHOW) > screen.drawn.rindex(HIDE)
