"""MAVProxy, as its users run it, talks to the emulated ATmega328P over a pseudo-terminal."""

import signal
import subprocess
import sys
import time
from collections.abc import Iterator

import numpy as np
import pytest
from boards import require_or_skip
from designs import design
from station import PATIENCE_S, GroundStation, require_station

from hostkit.design_file import save_design
from hostkit.link.frames.decoder import Decoder
from hostkit.link.logs.tlog import read_tlog
from hostkit.recordings import save
from hostkit.simulation import SensorErrors, simulate

DESIGN = design(accel_full_scale_g=4)
TURN_ON_RATE_RAD_S = 0.05


@pytest.fixture(scope="module")
def port(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """A still sensor, whose gyroscope has an offset, on an emulated AVR."""
    require_or_skip("make", "avr-gcc", "node", "avr8js", "clang", "wasm-ld")
    require_station()
    folder = tmp_path_factory.mktemp("mavproxy")
    recording = simulate(
        "rest",
        duration_s=20.0,
        rate_hz=DESIGN.rate_hz,
        sensor=DESIGN.sensor,
        errors=SensorErrors(gyro_bias_rad_s=(TURN_ON_RATE_RAD_S,) * 3),
        rng=np.random.default_rng(1),
    )
    save(recording, folder / "rest.csv")
    save_design(DESIGN, folder / "design.json")
    command = [sys.executable, "-m", "hostkit", "emulate", str(folder / "design.json"), "--pty"]
    command += ["--target", "atmega328p", "--recording", str(folder / "rest.csv")]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as p:
        try:
            assert p.stdout is not None
            path = p.stdout.readline().strip()
            assert path, p.stderr and p.stderr.read()
            yield path
        finally:
            p.send_signal(signal.SIGINT)
            p.communicate(timeout=30)


@pytest.fixture(scope="module")
def station(port: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[GroundStation]:
    station = GroundStation(port, tmp_path_factory.mktemp("station"))
    try:
        yield station
    finally:
        station.close()


def test_heartbeat_puts_it_on_line(station: GroundStation) -> None:
    station.see(r"online system 1")


def test_attitude_is_shown(station: GroundStation) -> None:
    shown = station.see(r"ATTITUDE \{.*roll : (-?[\d.e-]+)", asking="status ATTITUDE")
    assert abs(float(shown.group(1))) < 0.2


def test_parameters_are_listed(station: GroundStation) -> None:
    station.see(r"FILT_TAU +([\d.]+)", asking="param show FILT_TAU")
    station.see(r"Received \d+ parameters")


def test_a_parameter_is_set_and_shown(station: GroundStation) -> None:
    station.type("param set FILT_TAU 1.5")
    station.see(r"FILT_TAU +1\.50?0", asking="param show FILT_TAU")


def test_the_gyroscope_is_calibrated(station: GroundStation) -> None:
    station.type("gyrocal")
    station.see(r"COMMAND_ACK: PREFLIGHT_CALIBRATION: ACCEPTED")
    near = r"GYRO_BIAS_ROLL +(0\.0(?:4[5-9]|5[0-4]?)\d*)"  # told in its own time, after the answer
    shown = station.see(near, asking="param show GYRO_BIAS_ROLL")
    assert abs(float(shown.group(1)) - TURN_ON_RATE_RAD_S) < 0.005


def test_a_message_interval_is_set(station: GroundStation) -> None:
    station.type("long SET_MESSAGE_INTERVAL 30 100000")
    station.see(r"COMMAND_ACK: SET_MESSAGE_INTERVAL: ACCEPTED")
    asked_ms = attitude_ms(station)[-1]
    deadline = time.monotonic() + PATIENCE_S
    while len(since := [t for t in attitude_ms(station) if t > asked_ms]) < 15:
        assert time.monotonic() < deadline, f"{len(since)} ATTITUDE came"
        time.sleep(0.2)
    # Ten samples of 10 ms, each stamped in whole milliseconds.
    assert np.median(np.diff(since)) == pytest.approx(100, abs=1)


def attitude_ms(station: GroundStation) -> list[int]:
    """Return the device's times of the ATTITUDE messages that MAVProxy has logged so far."""
    decoder = Decoder()
    raw = read_tlog(station.folder / "link.tlog")
    frames = [frame for piece in raw for frame in decoder.feed(piece)]
    return [frame.message.time_boot_ms for frame in frames if frame.name == "ATTITUDE"]
