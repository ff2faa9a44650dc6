"""What tests of a live session share: programs that run beside them, and a watched browser."""

import contextlib
import os
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import urlsplit

import numpy as np
import pytest
import serial
from designs import design

from hostkit.design_file import save_design
from hostkit.recordings import save
from hostkit.simulation import SensorErrors, simulate

CHROMIUM = "/usr/bin/chromium"
DESIGN = design(accel_full_scale_g=4)
PATIENCE_S = 60.0
START_S = 60.0
POLL_MS = 50


def write_inputs(folder: Path) -> None:
    """Write ``design.json`` and ``sweep.csv``."""
    recording = simulate(
        "sine-sweep",
        duration_s=5.0,
        rate_hz=DESIGN.rate_hz,
        sensor=DESIGN.sensor,
        errors=SensorErrors(),
        rng=np.random.default_rng(1),
    )
    save(recording, folder / "sweep.csv")
    save_design(DESIGN, folder / "design.json")


class Program:
    """hostkit as a process, and what it says on either stream."""

    def __init__(self, folder: Path, *arguments: str) -> None:
        self.said = ""
        self._child = subprocess.Popen(
            [sys.executable, "-m", "hostkit", *arguments],
            cwd=folder,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            env={**os.environ, "PYTHONUNBUFFERED": "1"},
        )
        assert self._child.stdout is not None
        assert self._child.stderr is not None
        self._readers = [
            threading.Thread(target=self._read, args=(stream.fileno(),), daemon=True)
            for stream in (self._child.stdout, self._child.stderr)
        ]
        for reader in self._readers:
            reader.start()

    def _read(self, descriptor: int) -> None:
        while piece := os.read(descriptor, 4096):
            self.said += piece.decode(errors="replace")

    def see(self, pattern: str) -> str:
        """Wait until it says something; return that."""
        deadline = time.monotonic() + PATIENCE_S
        while time.monotonic() < deadline:
            if found := re.search(pattern, self.said):
                return found.group()
            if self._child.poll() is not None and not any(r.is_alive() for r in self._readers):
                break
            time.sleep(0.02)
        pytest.fail(f"it did not say {pattern!r}; it said: {self.said[-3000:]}")

    def end(self) -> int:
        """Interrupt it; return its exit code."""
        if self._child.poll() is None:
            self._child.send_signal(signal.SIGINT)
        try:
            self._child.wait(PATIENCE_S)
        except subprocess.TimeoutExpired:
            self._child.kill()
            self._child.wait()
            pytest.fail(f"it did not end when interrupted; it said: {self.said[-3000:]}")
        for reader in self._readers:
            reader.join()
        self._child.stdout.close()
        self._child.stderr.close()
        return self._child.returncode


@contextlib.contextmanager
def program(folder: Path, *arguments: str) -> Iterator[Program]:
    """Run hostkit for a while."""
    running = Program(folder, *arguments)
    try:
        yield running
    finally:
        running.end()


@contextlib.contextmanager
def emulated(design_file: Path, target: str, recording: Path, *options: str) -> Iterator[str]:
    """Serve a board on a pseudo-terminal; give its path once the board has said something.

    The emulator starts with the first reader, which takes longer on a busy machine than a session
    waits for a device.
    """
    command = [sys.executable, "-m", "hostkit", "emulate", str(design_file), "--pty"]
    command += ["--target", target, "--recording", str(recording), *options]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, stdout=pipe, stderr=pipe, text=True) as board:
        try:
            assert board.stdout is not None
            path = board.stdout.readline().strip()
            assert path, board.stderr and board.stderr.read()
            with serial.Serial(path, timeout=START_S) as reader:
                assert reader.read(1), f"nothing came in {START_S:g} s"
            yield path
        finally:
            board.send_signal(signal.SIGINT)
            board.communicate(timeout=START_S)
    assert board.returncode == 0


@dataclass
class Complaints:
    """What a page should not do: errors on its console, failed or foreign requests."""

    origin: str
    found: list[str] = field(default_factory=list)

    def watch(self, page) -> None:
        page.on("console", self._console)
        page.on("pageerror", lambda error: self.found.append(f"error: {error}"))
        page.on("request", self._request)
        page.on("response", self._response)

    def _console(self, message) -> None:
        if message.type in ("error", "warning"):
            self.found.append(f"console {message.type}: {message.text}")

    def _request(self, request) -> None:
        parts = urlsplit(request.url)
        local = f"{parts.scheme}://{parts.netloc}" == self.origin
        if not local and parts.scheme not in ("data", "blob"):
            self.found.append(f"foreign request: {request.url}")

    def _response(self, response) -> None:
        if response.status >= 400:
            self.found.append(f"status {response.status}: {response.url}")


@contextlib.contextmanager
def browser() -> Iterator[object]:
    """Run the system's Chromium."""
    sync_api = pytest.importorskip("playwright.sync_api")
    if not Path(CHROMIUM).exists():
        pytest.skip("chromium is not installed: sudo apt-get install chromium")
    with sync_api.sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        try:
            yield chromium
        finally:
            chromium.close()


def until(page, question: Callable[[], bool], what: str) -> None:
    """Ask a page again and again; its policy forbids what Playwright would do for that itself."""
    deadline = time.monotonic() + PATIENCE_S
    while not question():
        if time.monotonic() > deadline:
            pytest.fail(f"not seen in {PATIENCE_S:g} s: {what}")
        page.wait_for_timeout(POLL_MS)


@contextlib.contextmanager
def watched_page(chromium, url: str) -> Iterator[object]:
    """Open a page; at the end it must have had nothing to complain of."""
    parts = urlsplit(url)
    complaints = Complaints(f"{parts.scheme}://{parts.netloc}")
    context = chromium.new_context(viewport={"width": 1280, "height": 800}, accept_downloads=True)
    context.set_default_timeout(1000 * PATIENCE_S)
    try:
        page = context.new_page()
        complaints.watch(page)
        page.goto(url)
        yield page
        assert complaints.found == []
    finally:
        context.close()
