from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from hostkit.attitude import inclination_rad, pitch_from_up, roll_from_up
from hostkit.errors import DesignError, HostkitError
from hostkit.recordings import Recording, check, load, save
from hostkit.records import SensorConfig
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import quantise
from hostkit.simulation import PROFILES, SensorErrors, at_rest, simulate
from hostkit.simulation.curves import Curve, constant, multisine, ramp, stairs, sweep
from hostkit.simulation.motion import Path as Path3d
from hostkit.simulation.motion import motion_at
from hostkit.units import DEG_PER_RAD, RAD_PER_DEG, STANDARD_GRAVITY_M_S2

PART = SENSORS["mpu6050"]
SENSOR = SensorConfig(
    part="mpu6050", gyro_full_scale_deg_s=500, accel_full_scale_g=4, low_pass_setting=3
)
NONE = SensorErrors.none()


def run(
    profile: str = "free",
    *,
    duration_s: float = 20.0,
    rate_hz: float = 100.0,
    sensor: SensorConfig = SENSOR,
    errors: SensorErrors = NONE,
    seed: int = 1,
) -> Recording:
    rng = np.random.default_rng(seed)
    return simulate(
        profile, duration_s=duration_s, rate_hz=rate_hz, sensor=sensor, errors=errors, rng=rng
    )


# --- motion --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("roll_deg", "pitch_deg", "axis", "sign"),
    [(0, 0, 2, 1), (180, 0, 2, -1), (90, 0, 1, 1), (-90, 0, 1, -1), (0, -90, 0, 1), (0, 90, 0, -1)],
)
def test_six_faces_read_one_g(roll_deg: float, pitch_deg: float, axis: int, sign: int) -> None:
    recording = simulate(
        at_rest(roll_deg * RAD_PER_DEG, pitch_deg * RAD_PER_DEG),
        duration_s=1.0,
        rate_hz=100.0,
        sensor=SENSOR,
        errors=SensorErrors(noise=0.0, accel_offset_m_s2=(0, 0, 0), accel_scale=(0, 0, 0),
                            cross_axis=0.0),
        rng=np.random.default_rng(1),
    )  # fmt: skip
    expected = np.zeros(3)
    expected[axis] = sign * STANDARD_GRAVITY_M_S2
    half_count = 0.5 * PART.m_s2_per_count(SENSOR)
    assert np.abs(recording.specific_force_m_s2 - expected).max() <= half_count + 1e-12


@pytest.mark.parametrize("profile", PROFILES.names())
def test_rate_turns_the_reference(profile: str) -> None:
    """d(up)/dt = up x rate: integrated in fine steps, the ideal gyroscope gives the reference."""
    recording = run(profile, rate_hz=1000.0)
    assert recording.up_reference is not None
    up = recording.up_reference[0]
    worst = 0.0
    rate = recording.angular_rate_rad_s
    for before, after, true in zip(rate[:-1], rate[1:], recording.up_reference[1:], strict=True):
        up = turned_back(up, 0.5 * (before + after) / recording.rate_hz)
        worst = max(worst, float(np.linalg.norm(up - true)))
    assert worst < 2e-4


def turned_back(vector: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Express a world-fixed vector in axes that turned by a rotation vector (Rodrigues)."""
    size = float(np.linalg.norm(angle))
    if size == 0.0:
        return vector
    axis = angle / size
    cross = np.cross(axis, vector)
    along = axis * (axis @ vector)
    return vector * np.cos(size) - cross * np.sin(size) + along * (1.0 - np.cos(size))


def test_positive_rates_raise_roll_and_pitch() -> None:
    recording = run("steps", rate_hz=1000.0)
    assert recording.up_reference is not None
    roll, pitch = roll_from_up(recording.up_reference), pitch_from_up(recording.up_reference)
    roll_rate, pitch_rate = 1000.0 * np.gradient(roll), 1000.0 * np.gradient(pitch)
    rate = recording.angular_rate_rad_s
    np.testing.assert_allclose(rate[:, 0], roll_rate, atol=0.05)
    np.testing.assert_allclose(rate[:, 1], pitch_rate * np.cos(roll), atol=0.05)
    assert np.abs(roll_rate).max() > 1.0
    assert np.abs(pitch_rate).max() > 1.0


@pytest.mark.parametrize("profile", ["rest", "sine-sweep", "steps", "random"])
def test_force_without_acceleration_is_gravity(profile: str) -> None:
    recording = run(profile)
    assert recording.up_reference is not None
    np.testing.assert_allclose(
        recording.specific_force_m_s2, STANDARD_GRAVITY_M_S2 * recording.up_reference, atol=1e-12
    )


def test_free_motion_accelerates_and_turns_over() -> None:
    recording = run("free", duration_s=60.0)
    assert recording.up_reference is not None
    added = recording.specific_force_m_s2 - STANDARD_GRAVITY_M_S2 * recording.up_reference
    np.testing.assert_allclose(np.sqrt(np.mean(added**2, axis=0)), 0.7, atol=0.1)
    assert recording.up_reference[:, 2].min() < -0.5
    assert recording.up_reference[:, 2].max() > 0.9


def test_acceleration_is_turned_into_body_axes() -> None:
    """Against another library: body to world is Rz(yaw) Ry(pitch) Rx(roll)."""
    angles = {"roll_rad": 0.5, "pitch_rad": -0.7, "yaw_rad": 2.1}
    path = Path3d(
        **{name: constant(angle) for name, angle in angles.items()},
        acceleration_m_s2=tuple(constant(value) for value in (1.0, -2.0, 3.0)),
    )
    to_world = Rotation.from_euler("ZYX", [2.1, -0.7, 0.5])
    expected = to_world.inv().apply((1.0, -2.0, 3.0 + STANDARD_GRAVITY_M_S2))
    force = motion_at(path, np.zeros(1)).specific_force_m_s2[0]
    np.testing.assert_allclose(force, expected, atol=1e-12)


@pytest.mark.parametrize(
    "curve",
    [
        ramp(0.3),
        sweep(amplitude=0.5, band_hz=(0.05, 1.5), rise_s=60.0, phase=0.3),
        multisine(rms=0.4, band_hz=(0.05, 1.0), rng=np.random.default_rng(1)),
        stairs(levels=np.array((0.0, 1.0, -0.5)), hold_s=2.0, move_s=0.6),
    ],
)
def test_slope_is_the_derivative(curve: Curve) -> None:
    time_s = np.arange(-2.0, 70.0, 1e-3)
    samples = curve(time_s)
    slope = (samples.value[2:] - samples.value[:-2]) / 2e-3
    np.testing.assert_allclose(samples.slope[1:-1], slope, atol=2e-4)


def test_multisine_has_its_strength_and_band() -> None:
    curve = multisine(rms=0.4, band_hz=(0.5, 1.0), rng=np.random.default_rng(2))
    value = curve(np.arange(100_000) / 100.0).value
    assert np.std(value) == pytest.approx(0.4, rel=0.02)
    power = np.abs(np.fft.rfft(value)) ** 2
    hertz = np.fft.rfftfreq(len(value), 0.01)
    assert power[(hertz > 0.49) & (hertz < 1.01)].sum() > 0.99 * power.sum()


# --- sensor --------------------------------------------------------------------------------------


@pytest.mark.parametrize("setting", [0, 1, 2, 3, 4, 5, 6])
def test_noise_is_that_of_the_datasheet(setting: int) -> None:
    """Density times root of the noise bandwidth; 0.05 deg/s rms at setting 2."""
    sensor = replace(SENSOR, low_pass_setting=setting, gyro_full_scale_deg_s=250)
    recording = run(
        "rest", duration_s=100.0, sensor=sensor, errors=replace(NONE, noise=1.0, low_pass=True)
    )
    low_pass = PART.low_pass(sensor)
    gyro = PART.noise.gyro_noise_density_rad_s_rthz * np.sqrt(low_pass.gyro_bandwidth_hz)
    accel = PART.noise.accel_noise_density_m_s2_rthz * np.sqrt(low_pass.accel_bandwidth_hz)
    np.testing.assert_allclose(recording.angular_rate_rad_s.std(axis=0), gyro, rtol=0.07)
    np.testing.assert_allclose(recording.specific_force_m_s2.std(axis=0), accel, rtol=0.07)
    if setting == 2:
        assert recording.angular_rate_rad_s.std() * DEG_PER_RAD == pytest.approx(0.05, rel=0.05)


def lag_s(late: np.ndarray, early: np.ndarray, rate_hz: float) -> float:
    """Lag of one signal against another: the shift at which they differ least, interpolated.

    That is the peak of the cross-correlation, less half the energy of the shifted signal.
    """
    reach = 60
    inner = slice(reach, len(early) - reach)
    shifted = [early[reach - k : len(early) - reach - k] for k in range(-reach, reach)]
    products = np.array([late[inner] @ part - 0.5 * part @ part for part in shifted])
    top = int(np.argmax(products))
    before, peak, after = products[top - 1 : top + 2]
    return float(top - reach + 0.5 * (before - after) / (before - 2.0 * peak + after)) / rate_hz


@pytest.mark.parametrize("setting", [0, 1, 2, 3, 4, 5, 6])
def test_delay_is_that_of_the_low_pass(setting: int) -> None:
    sensor = replace(SENSOR, low_pass_setting=setting)
    ideal = run("random", rate_hz=1000.0, sensor=sensor)
    real = run("random", rate_hz=1000.0, sensor=sensor, errors=replace(NONE, low_pass=True))
    low_pass = PART.low_pass(sensor)
    for axis in (0, 1):
        gyro = lag_s(real.angular_rate_rad_s[:, axis], ideal.angular_rate_rad_s[:, axis], 1000.0)
        assert gyro == pytest.approx(low_pass.gyro_delay_s, abs=5e-5)
    accel = lag_s(real.specific_force_m_s2[:, 0], ideal.specific_force_m_s2[:, 0], 1000.0)
    assert accel == pytest.approx(low_pass.accel_delay_s, abs=5e-5)


@pytest.mark.parametrize("setting", [2, 3, 4, 5, 6])
def test_bandwidth_is_that_of_the_low_pass(setting: int) -> None:
    """White noise through the filter falls to half its power at the bandwidth."""
    sensor = replace(SENSOR, low_pass_setting=setting)
    noise = replace(NONE, noise=1.0, low_pass=True)
    recording = run("rest", duration_s=200.0, rate_hz=1000.0, sensor=sensor, errors=noise)
    blocks = recording.angular_rate_rad_s[:200_000].reshape(100, 2000, 3)
    power = np.mean(np.abs(np.fft.rfft(blocks, axis=1)) ** 2, axis=(0, 2))
    bandwidth_hz = PART.low_pass(sensor).gyro_bandwidth_hz
    index = round(bandwidth_hz * 2.0)
    passed = power[1 : index // 4 + 2].mean()
    near = slice(index - max(1, index // 20), index + max(1, index // 20) + 1)
    assert power[near].mean() / passed == pytest.approx(0.5, abs=0.06)


def test_values_are_counts_within_the_range() -> None:
    sensor = replace(SENSOR, gyro_full_scale_deg_s=250, accel_full_scale_g=2)
    recording = run("free", duration_s=60.0, sensor=sensor, errors=SensorErrors())
    counts = recording.angular_rate_rad_s / PART.rad_s_per_count(sensor)
    assert np.abs(counts - np.round(counts)).max() < 1e-9
    assert counts.max() <= 32767.0 + 1e-9
    assert counts.min() >= -32768.0 - 1e-9
    force = recording.specific_force_m_s2 / PART.m_s2_per_count(sensor)
    assert np.abs(force - np.round(force)).max() < 1e-9


def test_too_fast_a_motion_is_clipped_and_found() -> None:
    sensor = replace(SENSOR, gyro_full_scale_deg_s=250)
    errors = replace(NONE, counts=True, gyro_scale=(1.0, 0.0, 0.0))
    recording = run("free", duration_s=60.0, sensor=sensor, errors=errors)
    weight = PART.rad_s_per_count(sensor)
    assert recording.angular_rate_rad_s[:, 0].min() == -32768 * weight
    assert recording.angular_rate_rad_s[:, 0].max() == 32767 * weight
    messages = [f.message for f in check(recording).findings if f.kind == "clipping"]
    assert any(text.startswith("gyro x stays at 4.3632") for text in messages)


def test_counts_round_halves_upwards() -> None:
    values = np.array((0.5, -0.5, 1.49, -1.5, 40000.0, -40000.0))
    np.testing.assert_array_equal(quantise(values, 1.0), (1, 0, 1, -1, 32767, -32768))


def test_constant_errors_are_what_was_asked_for() -> None:
    errors = replace(
        NONE,
        gyro_bias_rad_s=(0.01, -0.02, 0.03),
        accel_offset_m_s2=(0.1, 0.2, -0.3),
        accel_scale=(0.0, 0.0, 0.01),
        cross_axis=0.002,
    )
    recording = run("rest", errors=errors)
    g = STANDARD_GRAVITY_M_S2
    np.testing.assert_allclose(recording.angular_rate_rad_s[7], (0.01, -0.02, 0.03))
    np.testing.assert_allclose(
        recording.specific_force_m_s2[7], (0.1 + 0.002 * g, 0.2 + 0.002 * g, -0.3 + 1.01 * g)
    )


def test_bias_walks() -> None:
    errors = replace(NONE, gyro_bias_walk_rad_s_rts=0.01)
    ends = [run("rest", errors=errors, seed=s).angular_rate_rad_s[-1] for s in range(60)]
    assert np.std(ends) == pytest.approx(0.01 * np.sqrt(20.0), rel=0.15)


def test_vibration_has_its_strength_before_the_filter() -> None:
    errors = replace(NONE, vibration_m_s2=2.0)
    still, shaken = run("rest"), run("rest", errors=errors)
    added = shaken.specific_force_m_s2 - still.specific_force_m_s2
    np.testing.assert_allclose(added.std(axis=0), 2.0, rtol=0.1)
    np.testing.assert_array_equal(shaken.angular_rate_rad_s, still.angular_rate_rad_s)
    slow = replace(SENSOR, low_pass_setting=6)
    smoothed = run("rest", errors=replace(errors, low_pass=True), sensor=slow)
    assert smoothed.specific_force_m_s2.std(axis=0).max() < 0.2


def test_typical_sensor_is_near_the_truth() -> None:
    recording = run("steps", errors=SensorErrors())
    assert recording.up_reference is not None
    error = inclination_rad(recording.specific_force_m_s2, recording.up_reference)
    assert 0.1 < np.median(error) * DEG_PER_RAD < 2.0


# --- the recording -------------------------------------------------------------------------------


def test_same_seed_same_bytes(tmp_path: Path) -> None:
    for name, seed in (("a", 5), ("b", 5), ("c", 6)):
        for suffix in (".npz", ".csv"):
            save(run(errors=SensorErrors(), seed=seed), tmp_path / (name + suffix))
    for suffix in (".npz", ".csv"):
        a, b, c = ((tmp_path / (name + suffix)).read_bytes() for name in "abc")
        assert a == b
        assert a != c


def test_the_motion_does_not_depend_on_the_sensor() -> None:
    wide = replace(SENSOR, gyro_full_scale_deg_s=2000, low_pass_setting=6)
    typical, ideal = run(errors=SensorErrors(), sensor=wide), run()
    np.testing.assert_array_equal(typical.up_reference, ideal.up_reference)


@pytest.mark.parametrize("rate_hz", [3.90625, 10.0, 125.0, 1000.0])
def test_length_and_times(tmp_path: Path, rate_hz: float) -> None:
    recording = run("random", rate_hz=rate_hz, duration_s=2.0, errors=SensorErrors())
    assert len(recording) == round(2.0 * rate_hz)
    np.testing.assert_array_equal(recording.time_s, np.arange(len(recording)) / rate_hz)
    assert recording.valid.all()
    save(recording, tmp_path / "a.csv")
    assert load(tmp_path / "a.csv").rate_hz == rate_hz


@pytest.mark.parametrize(
    ("changes", "error", "message"),
    [
        ({"profile": "loop"}, HostkitError, "no profile is called 'loop'; known are: rest, sine-"),
        ({"duration_s": 0.01}, HostkitError, r"duration_s = 0\.01 is outside \[0\.02, "),
        ({"duration_s": 1e7}, HostkitError, r"duration_s = 1e\+07 is outside"),
        ({"duration_s": float("nan")}, HostkitError, "duration_s = nan is outside"),
        ({"rate_hz": 30.0}, DesignError, r"nearest is 30\.303 Hz"),
        ({"rate_hz": 0.0}, HostkitError, "rate_hz = 0.0 is not a sample rate"),
        ({"rate_hz": float("nan")}, HostkitError, "rate_hz = nan is not a sample rate"),
        ({"sensor": replace(SENSOR, gyro_full_scale_deg_s=300)}, DesignError, "= 300 is not a ran"),
        ({"sensor": replace(SENSOR, low_pass_setting=7)}, DesignError, "low_pass_setting = 7"),
        ({"sensor": replace(SENSOR, part="bmi160")}, HostkitError, "no sensor is called 'bmi160'"),
    ],
)
def test_wrong_values_are_named(
    changes: dict[str, object], error: type[HostkitError], message: str
) -> None:
    with pytest.raises(error, match=message):
        run(**changes)  # type: ignore[arg-type]


def test_negative_strength_is_refused() -> None:
    with pytest.raises(HostkitError, match=r"vibration_m_s2 = -1\.0 is negative"):
        SensorErrors(vibration_m_s2=-1.0)
