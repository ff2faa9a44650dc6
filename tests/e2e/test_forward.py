"""MAVProxy works through a running monitor, which goes on judging the emulated ATmega328P."""

import json
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from boards import require_or_skip
from live import emulated, write_inputs
from station import PATIENCE_S, GroundStation, require_station

AFTER_CHANGE_SAMPLES = 100


@pytest.fixture(scope="module")
def board(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[str, Path]]:
    """The pty of an emulated AVR that is moved, and the file of its design."""
    require_or_skip("make", "avr-gcc", "node", "avr8js", "clang", "wasm-ld")
    require_station()
    folder = tmp_path_factory.mktemp("forward")
    write_inputs(folder)
    with emulated(folder / "design.json", "atmega328p", folder / "sweep.csv") as path:
        yield path, folder / "design.json"


class Plotter:
    """Reads the JSON output as PlotJuggler does: one object per datagram."""

    def __init__(self) -> None:
        self.samples: list[dict] = []
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind(("127.0.0.1", 0))
        self._socket.settimeout(0.2)
        self.port = self._socket.getsockname()[1]
        self._ended = False
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        while not self._ended:
            try:
                self.samples.append(json.loads(self._socket.recv(65536)))
            except TimeoutError:
                continue

    def wait_for(self, more: int) -> None:
        wanted, deadline = len(self.samples) + more, time.monotonic() + PATIENCE_S
        while len(self.samples) < wanted:
            assert time.monotonic() < deadline, f"{len(self.samples)} of {wanted} samples came"
            time.sleep(0.05)

    def close(self) -> None:
        self._ended = True
        self._reader.join(5.0)
        self._socket.close()


def free_udp_port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as found:
        found.bind(("127.0.0.1", 0))
        return int(found.getsockname()[1])


def test_a_station_sets_a_parameter_through_the_monitor(
    board: tuple[str, Path], tmp_path: Path
) -> None:
    pty, design_file = board
    port, plotter = free_udp_port(), Plotter()
    station = GroundStation(f"udpin:127.0.0.1:{port}", tmp_path)
    command = [sys.executable, "-m", "hostkit", "monitor", str(design_file), "--port", pty]
    command += ["--forward", f"udp:127.0.0.1:{port}", "--json", "--max-lost-percent", "100"]
    command += ["--json-udp", f"127.0.0.1:{plotter.port}"]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, stdout=pipe, stderr=pipe, text=True) as monitor:
        try:
            station.see(r"online system 1")
            station.see(r"FILT_TAU +2\.84", asking="param show FILT_TAU")
            station.type("param set FILT_TAU 1.5")
            station.see(r"FILT_TAU +1\.50?0", asking="param show FILT_TAU")
            plotter.wait_for(AFTER_CHANGE_SAMPLES)
        finally:
            monitor.send_signal(signal.SIGINT)
            out, err = monitor.communicate(timeout=30)
            print(err[-2000:])
            station.close()
            plotter.close()
    result = json.loads(out)
    assert monitor.returncode == 0, err
    assert result["mismatches"] == 0
    assert result["verdict"] == "pass"
    assert result["checked"] > AFTER_CHANGE_SAMPLES
    (changed,) = result["retuned"]
    assert changed["name"] == "FILT_TAU"
    assert changed["device_value"] == pytest.approx(1.5, rel=1e-5)
    assert_plotted(plotter.samples)


def assert_plotted(samples: list[dict]) -> None:
    """The plotter got even times, both axes, and no mismatch, before the change and behind it."""
    times = [sample["timestamp"] for sample in samples]
    assert abs(times[-1] - time.time()) < PATIENCE_S
    assert np.median(np.diff(times)) == pytest.approx(0.01, abs=2e-4)
    assert {frozenset(sample) for sample in samples} == {
        frozenset({"timestamp", "device_time_s", "mismatch", "roll", "pitch"})
    }
    assert not any(sample["mismatch"] for sample in samples)
    followed = [sample["roll"] for sample in samples if "residual_deg" in sample["roll"]]
    assert len(followed) > AFTER_CHANGE_SAMPLES
    assert max(abs(roll["residual_deg"]) for roll in followed) < 0.01
    assert max(abs(roll["device_deg"]) for roll in followed) > 1.0
