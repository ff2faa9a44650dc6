"""An emulated device on a pseudo-terminal, and what a process beside it costs."""

import contextlib
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hostkit.design_file import save_design
from hostkit.errors import HostkitError
from hostkit.filters.complementary import parameters
from hostkit.mounting import Mounting
from hostkit.recordings import save
from hostkit.records import FilterDesign, SensorConfig
from hostkit.simulation import SensorErrors, simulate

TAU_S = 0.35
BAUD = 4_000_000
MESSAGES = ("TILT_SAMPLE", "ATTITUDE", "SCALED_IMU")
RECORDING_S = 5.0
TICKS_PER_S = os.sysconf("SC_CLK_TCK") if hasattr(os, "sysconf") else 100


@dataclass(frozen=True, slots=True, kw_only=True)
class LiveDevice:
    """An emulated device: its design, and the port that it talks on."""

    design_file: Path
    port: str


@contextlib.contextmanager
def live_device(rate_hz: float, messages: tuple[str, ...] = MESSAGES) -> Iterator[LiveDevice]:
    """Serve the host firmware, which sends so many messages with every sample."""
    with tempfile.TemporaryDirectory(prefix="hostkit-bench-") as text:
        folder = Path(text)
        _write_inputs(folder, rate_hz)
        command = [*hostkit("emulate", str(folder / "design.json")), "--target", "host", "--pty"]
        command += ["--recording", str(folder / "sweep.csv"), "--baud", str(BAUD)]
        for name in MESSAGES:
            command += ["--message", f"{name}={rate_hz if name in messages else 0:g}"]
        with running(command, stdout=subprocess.PIPE) as child:
            assert child.stdout is not None
            port = child.stdout.readline().decode().strip()
            if not port:
                raise HostkitError("the emulated device did not start")
            yield LiveDevice(design_file=folder / "design.json", port=port)


def _write_inputs(folder: Path, rate_hz: float) -> None:
    sensor = SensorConfig(
        part="mpu6050",
        gyro_full_scale_deg_s=500,
        accel_full_scale_g=4,
        low_pass_setting=1 if rate_hz > 400 else 3,
    )
    design = FilterDesign(
        filter="complementary",
        axes="both",
        tilt="atan2",
        mounting=Mounting(),
        rate_hz=rate_hz,
        sensor=sensor,
        parameters=parameters(TAU_S / (TAU_S + 1.0 / rate_hz)),
    )
    recording = simulate(
        "sine-sweep",
        duration_s=RECORDING_S,
        rate_hz=rate_hz,
        sensor=sensor,
        errors=SensorErrors(),
        rng=np.random.default_rng(1),
    )
    save(recording, folder / "sweep.csv")
    save_design(design, folder / "design.json")


def hostkit(*arguments: str) -> list[str]:
    """Return a command line of this hostkit."""
    return [sys.executable, "-m", "hostkit", *arguments]


@contextlib.contextmanager
def running(
    command: list[str], *, stdout: int = subprocess.DEVNULL, stderr: int = subprocess.DEVNULL
) -> Iterator[subprocess.Popen[bytes]]:
    """Run a command for a while; it is interrupted at the end, as by Ctrl-C."""
    with subprocess.Popen(command, stdout=stdout, stderr=stderr, stdin=subprocess.PIPE) as child:
        try:
            yield child
        finally:
            if child.poll() is None:
                child.send_signal(signal.SIGINT)
            try:
                child.wait(20.0)
            except subprocess.TimeoutExpired:
                child.kill()


def cpu_seconds(pid: int) -> float:
    """Return the time that a process has computed, all its threads, s.

    Raises
    ------
    HostkitError
        If the system has no /proc.
    """
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError as error:
        raise HostkitError(f"the cost of a process is read from /proc: {error}") from error
    return (int(fields[11]) + int(fields[12])) / TICKS_PER_S


def memory_bytes(pid: int) -> int:
    """Return the memory that a process has resident."""
    for line in Path(f"/proc/{pid}/status").read_text().splitlines():
        if line.startswith("VmRSS:"):
            return int(line.split()[1]) * 1024
    raise HostkitError(f"process {pid} has ended")


@dataclass(frozen=True, slots=True, kw_only=True)
class Cost:
    """What a process took while it was watched.

    Attributes
    ----------
    cpu_share
        Of one core, over the whole time.
    early_bytes, late_bytes
        Resident memory after a tenth of the time, and at its end.
    """

    cpu_share: float
    early_bytes: int
    late_bytes: int


def watch(pid: int, duration_s: float) -> Cost:
    """Watch a process for so long."""
    begun, spent_s = time.monotonic(), cpu_seconds(pid)
    time.sleep(duration_s / 10.0)
    early = memory_bytes(pid)
    time.sleep(max(begun + duration_s - time.monotonic(), 0.0))
    taken_s = time.monotonic() - begun
    return Cost(
        cpu_share=(cpu_seconds(pid) - spent_s) / taken_s,
        early_bytes=early,
        late_bytes=memory_bytes(pid),
    )
