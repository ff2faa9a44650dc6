"""The live monitor: what it loses and takes at 1 kHz, how late the page is, how it starts."""

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from benchmarks.live_device import (
    MESSAGES,
    Cost,
    LiveDevice,
    cpu_seconds,
    hostkit,
    live_device,
    running,
    watch,
)
from benchmarks.live_page import page_table
from benchmarks.table import Table, figure
from hostkit.cli.inputs import say
from hostkit.errors import HostkitError

CHOICE = "HOSTKIT_BENCH_SECONDS"
"""Environment variable: how long the monitor is watched."""

SECONDS, LEAST_S = 60.0, 5.0
PEER_S = 30.0
RATE_HZ = 1000.0
SETTLED_S = 2.0
"""A process is watched from so long after it was started."""

STARTS = 5


@dataclass(frozen=True, slots=True, kw_only=True)
class Sustained:
    """A process that received for a while; `lost` are messages that did not arrive."""

    name: str
    messages: float
    lost: int
    cost: Cost

    def row(self, peer: Cost) -> tuple[str, ...]:
        """Return it as a row, held against the peer."""
        return (
            self.name,
            f"{self.messages:.0f}",
            f"{self.lost}",
            figure(100.0 * self.cost.cpu_share),
            figure(self.cost.cpu_share / peer.cpu_share),
            figure(self.cost.early_bytes / 1e6),
            figure(self.cost.late_bytes / 1e6),
        )


def tables() -> Iterator[Table]:
    """Measure the monitor beside an emulated device."""
    duration_s = wanted_seconds(os.environ.get(CHOICE, ""))
    with live_device(RATE_HZ) as device:
        yield sustained(device, duration_s)
        yield starts(device)
    yield page_table()


def wanted_seconds(text: str) -> float:
    """Return how long to measure.

    Raises
    ------
    HostkitError
        If it is no number of seconds, or too short for a figure.
    """
    try:
        seconds = float(text) if text else SECONDS
    except ValueError:
        raise HostkitError(f"{CHOICE} = {text!r} is no number of seconds, such as 600") from None
    if not seconds >= LEAST_S:
        raise HostkitError(f"{CHOICE} = {text}: the least is {LEAST_S:g} s")
    return seconds


def sustained(device: LiveDevice, duration_s: float) -> Table:
    """Hold the monitor against pymavlink's own loop, one after the other on the same device."""
    say(f"monitor: receives for {duration_s:g} s, then its peer for {min(duration_s, PEER_S):g} s")
    short_s = min(duration_s, PEER_S)
    rows = [_monitor(device, duration_s), _monitor(device, short_s, "--passive")]
    peer = _peer(device, short_s)
    return Table(
        title=f"Monitor: {' + '.join(MESSAGES)}, each at {RATE_HZ:g} Hz, {duration_s:g} s",
        columns=(
            "contender",
            "messages",
            "lost",
            "% of one core",
            "ratio to the peer",
            "memory after a tenth, MB",
            "at the end, MB",
        ),
        rows=tuple(one.row(peer.cost) for one in (*rows, peer)),
        remarks=("Lost are gaps in the numbers of frames and of samples, and bytes dropped.",),
    )


def _monitor(device: LiveDevice, duration_s: float, *more: str) -> Sustained:
    with tempfile.TemporaryDirectory(prefix="hostkit-bench-") as folder:
        command = hostkit("monitor", str(device.design_file), "--port", device.port, "--json")
        command += ["--duration", str(duration_s + 2 * SETTLED_S), *more]
        command += ["--record", str(Path(folder) / "all.tlog")]
        with running(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as child:
            time.sleep(SETTLED_S)
            cost = watch(child.pid, duration_s)
            out, err = child.communicate(timeout=60.0)
    try:
        found = json.loads(out)
    except ValueError:
        raise HostkitError(f"the monitor did not end well: {err.decode()[-300:]}") from None
    lost = found["lost"] + found["lost_frames"] + found.get("overrun_bytes", 0)
    name = " ".join(("hostkit monitor --record", *more))
    # All of it is what the messages of a sample are times the samples.
    return Sustained(name=name, messages=found["samples"] * len(MESSAGES), lost=lost, cost=cost)


def _peer(device: LiveDevice, duration_s: float) -> Sustained:
    command = [sys.executable, "-m", "benchmarks.receive_loop", device.port]
    with running([*command, str(duration_s + 2.0)], stdout=subprocess.PIPE) as child:
        assert child.stdout is not None
        child.stdout.readline()
        cost = watch(child.pid, duration_s)
        received, lost = map(int, child.stdout.read().split())
    return Sustained(name="pymavlink's loop, nothing kept", messages=received, lost=lost, cost=cost)


def starts(device: LiveDevice) -> Table:
    """Measure how long one waits for the first word of the device."""
    ours = hostkit("monitor", str(device.design_file), "--port", device.port)
    page = [*ours, "--web", "--no-browser"]
    station = [sys.executable, "-m", "MAVProxy.mavproxy", f"--master={device.port}"]
    station += ["--default-modules=link"]
    library = [sys.executable, "-c", "import sys, pymavlink.mavutil; print('here', flush=True)"]
    rows = (
        ("hostkit monitor: first verdict", ours, "so far"),
        ("hostkit monitor --web: address of the page", page, "http://"),
        ("MAVProxy: device is on line", station, "online system"),
        ("python: pymavlink is imported", library, "here"),
    )
    return Table(
        title=f"Start: median of {STARTS}",
        columns=("what", "seconds", "of them computing"),
        rows=tuple((name, *_until(command, word)) for name, command, word in rows),
    )


def _until(command: list[str], word: str) -> tuple[str, str]:
    """Measure how long a command takes until it prints a word, s."""
    taken, computed = zip(*(_once(command, word.encode()) for _ in range(STARTS)), strict=True)
    return figure(statistics.median(taken)), figure(statistics.median(computed))


def _once(command: list[str], word: bytes) -> tuple[float, float]:
    begun = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        child = subprocess.Popen(
            command,
            cwd=folder,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
        )
        try:
            assert child.stdout is not None
            said = b""
            while word not in said:
                piece = os.read(child.stdout.fileno(), 4096)
                if not piece:
                    raise HostkitError(f"{command[2]} ended: {said.decode()[-300:]}")
                said += piece
            return time.perf_counter() - begun, cpu_seconds(child.pid)
        finally:
            child.kill()
            child.communicate()
