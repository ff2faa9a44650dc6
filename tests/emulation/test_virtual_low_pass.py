"""The low-pass of the virtual sensor against the bandwidths and delays of the register map."""

import math
from pathlib import Path

import numpy as np
import pytest
from sensor_bench import CONFIG, INT_ENABLE, MS, POWER, SMPLRT_DIV, Bench, library

from hostkit.emulation.board import Stimulus
from hostkit.errors import DesignError
from hostkit.sensors import SENSORS
from hostkit.sensors.low_pass import low_pass_section

__all__ = ["library"]

PART = SENSORS["mpu6050"]
ROW_NS = 125_000
GYRO, ACCEL = 4, 0
AMPLITUDE = {GYRO: math.radians(200.0), ACCEL: 1.8 * 9.80665}
FULL_SCALE = {GYRO: math.radians(250.0), ACCEL: 2.0 * 9.80665}


def played(library: Path, signal: np.ndarray, setting: int, column: int) -> np.ndarray:
    """Counts of one axis at 1 kHz for a signal at 8 kHz, as shares of full scale."""
    feels = np.zeros((len(signal), 3))
    feels[:, 0] = signal
    still = np.zeros_like(feels)
    stimulus = Stimulus(
        angular_rate_rad_s=feels if column == GYRO else still,
        specific_force_m_s2=feels if column == ACCEL else still,
        temperature_deg_c=np.full(len(signal), 25.0),
    )
    bench = Bench(library, stimulus)
    bench.sensor.feel_motion(ROW_NS)
    bench.write(POWER, 1)
    bench.wait(100 * MS)
    bench.write(CONFIG, setting)
    bench.write(SMPLRT_DIV, 7 if setting == 0 else 0)
    bench.write(INT_ENABLE, 1)
    out = []
    for _ in range(len(signal) // 8):
        bench.wait(1 * MS)
        out.append(bench.burst()[column])
    return np.array(out) / 32768 * FULL_SCALE[column]


def response(library: Path, setting: int, column: int, frequency_hz: float) -> complex:
    """Gain and phase at a frequency, by correlation over whole periods after the transient."""
    periods = max(4, math.ceil(0.4 * frequency_hz))
    settle_s = 0.5
    time_s = np.arange(0, settle_s + periods / frequency_hz + 0.01, ROW_NS * 1e-9)
    signal = AMPLITUDE[column] * np.sin(2 * np.pi * frequency_hz * time_s)
    heard = played(library, signal, setting, column)
    at_s = np.arange(len(heard)) * 1e-3
    used = (at_s >= settle_s) & (at_s < settle_s + periods / frequency_hz)
    basis = np.stack(
        [f(2 * np.pi * frequency_hz * at_s[used]) for f in (np.sin, np.cos)] + [np.ones(used.sum())]
    )
    sine, cosine, _ = np.linalg.lstsq(basis.T, heard[used], rcond=None)[0] / AMPLITUDE[column]
    return complex(sine, cosine)


@pytest.mark.parametrize("column", [GYRO, ACCEL])
@pytest.mark.parametrize("low_pass", PART.low_passes[1:], ids=lambda lp: str(lp.setting))
def test_bandwidth_and_delay_are_those_of_the_register_map(
    library: Path, low_pass, column: int
) -> None:
    """-3 dB within 1 %, the delay at a twentieth of the bandwidth within 0.1 ms or 4 %."""
    is_gyro = column == GYRO
    bandwidth_hz = low_pass.gyro_bandwidth_hz if is_gyro else low_pass.accel_bandwidth_hz
    delay_s = low_pass.gyro_delay_s if is_gyro else low_pass.accel_delay_s
    edge = response(library, low_pass.setting, column, bandwidth_hz)
    assert abs(edge) == pytest.approx(math.sqrt(0.5), rel=0.01)
    slow_hz = bandwidth_hz / 20
    slow = response(library, low_pass.setting, column, slow_hz)
    assert abs(slow) == pytest.approx(1.0, abs=0.01)
    measured_s = -np.angle(slow) / (2 * np.pi * slow_hz)
    assert measured_s == pytest.approx(delay_s, abs=max(1e-4, 0.04 * delay_s))


@pytest.mark.parametrize("setting", [1, 3, 5, 6])
@pytest.mark.parametrize("share", [0.3, 2.0])
def test_the_gain_elsewhere_is_the_computed_one(library: Path, setting: int, share: float) -> None:
    low_pass = PART.low_passes[setting]
    frequency_hz = share * low_pass.gyro_bandwidth_hz
    section = low_pass_section(low_pass.gyro_bandwidth_hz, low_pass.gyro_delay_s, ROW_NS * 1e-9)
    z = np.exp(-2j * np.pi * frequency_hz * ROW_NS * 1e-9)
    b, a = section.numerator, section.denominator
    wanted = (b[0] + b[1] * z + b[2] * z**2) / (1 + a[0] * z + a[1] * z**2)
    got = response(library, setting, GYRO, frequency_hz)
    assert abs(got) == pytest.approx(abs(wanted), abs=0.01)


def test_setting_0_has_its_bandwidth(library: Path) -> None:
    assert abs(response(library, 0, GYRO, 256.0)) == pytest.approx(math.sqrt(0.5), rel=0.02)


def test_the_accelerometer_stays_at_1_khz_when_the_gyroscope_is_faster(library: Path) -> None:
    rows = 400
    ramp = np.linspace(0.0, 1.0, rows)[:, None] * np.ones(3)
    stimulus = Stimulus(
        angular_rate_rad_s=ramp,
        specific_force_m_s2=9.0 * ramp,
        temperature_deg_c=np.full(rows, 25.0),
    )
    bench = Bench(library, stimulus)
    bench.sensor.feel_motion(ROW_NS)
    bench.write(POWER, 1)
    bench.wait(100 * MS)
    bench.write(CONFIG, 0)
    bench.write(SMPLRT_DIV, 0)
    bench.write(INT_ENABLE, 1)
    heard = []
    for _ in range(200):
        bench.wait(ROW_NS)
        heard.append(bench.burst())
    accel, gyro = (np.array(heard)[40:, c] for c in (ACCEL, GYRO))
    assert (np.diff(gyro) > 0).all()
    steps = np.flatnonzero(np.diff(accel))
    assert (np.diff(steps) == 8).all()


def test_motion_goes_on_while_nobody_samples(library: Path) -> None:
    rows = 4000
    ramp = np.linspace(0.0, 4.0, rows)[:, None] * np.ones(3)
    stimulus = Stimulus(
        angular_rate_rad_s=ramp,
        specific_force_m_s2=ramp,
        temperature_deg_c=np.full(rows, 25.0),
        settle_samples=5,
    )
    bench = Bench(library, stimulus)
    bench.sensor.feel_motion(1 * MS)
    bench.configure(divider=9)
    bench.enable()
    bench.wait(60 * MS)
    assert bench.burst()[GYRO] == 0, "row 0 until the settle samples are over"
    bench.wait(500 * MS)
    assert bench.sensor.rows_played == 501
    bench.write(POWER, 0x41)
    bench.wait(500 * MS)
    bench.write(POWER, 0x01)
    bench.wait(100 * MS)
    assert 1080 <= bench.sensor.rows_played <= 1101
    bench.wait(4000 * MS)
    bench.burst()
    bench.read(0x3A)
    assert bench.sensor.exhausted


def test_a_filter_needs_fast_enough_ticks() -> None:
    with pytest.raises(DesignError, match="needs ticks of more than 200 Hz"):
        low_pass_section(100.0, 0.0, 0.01)
