"""MAVProxy, as its users run it, talks to the emulated ATmega328P over a pseudo-terminal."""

import time
from collections.abc import Iterator

import numpy as np
import pytest
from boards import require_or_skip
from designs import design
from live import emulated
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
    with emulated(folder / "design.json", "atmega328p", folder / "rest.csv") as path:
        yield path


@pytest.fixture(scope="module")
def station(port: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[GroundStation]:
    """A ground station that knows the device, so that each test may come first."""
    station = GroundStation(port, tmp_path_factory.mktemp("station"))
    try:
        station.see(r"online system 1")
        station.see(r"Received \d+ parameters")
        yield station
    finally:
        station.close()


def test_attitude_is_shown(station: GroundStation) -> None:
    shown = station.see(r"ATTITUDE \{.*roll : (-?[\d.e-]+)", asking="status ATTITUDE")
    assert abs(float(shown.group(1))) < 0.2


def test_it_is_online_and_its_parameters_are_listed(station: GroundStation) -> None:
    station.see(r"online system 1")
    station.see(r"Received \d+ parameters")
    station.see(r"FILT_TAU +([\d.]+)", asking="param show FILT_TAU")


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
    deadline = time.monotonic() + PATIENCE_S
    # The log lags the console, so messages from before the change may still come into it.
    while not comes_each(100, attitude_ms(station)[-11:]):
        assert time.monotonic() < deadline, attitude_ms(station)[-11:]
        time.sleep(0.2)


def comes_each(period_ms: int, times_ms: list[int]) -> bool:
    """Tell whether ten messages came so far apart, each stamped in whole milliseconds."""
    steps_ms = np.diff(times_ms)
    return len(steps_ms) == 10 and bool(np.all(np.abs(steps_ms - period_ms) <= 1))


def attitude_ms(station: GroundStation) -> list[int]:
    """Return the device's times of the ATTITUDE messages that MAVProxy has logged so far."""
    decoder = Decoder()
    raw = read_tlog(station.folder / "link.tlog")
    frames = [frame for piece in raw for frame in decoder.feed(piece)]
    return [frame.message.time_boot_ms for frame in frames if frame.name == "ATTITUDE"]
