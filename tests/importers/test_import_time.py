"""Times, grids, references and decimation: what every format shares."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial.transform import Rotation, Slerp

from hostkit.attitude import inclination_rad, up_from_quaternion
from hostkit.errors import RecordingError
from hostkit.importers.decimate import decimated
from hostkit.importers.log import ReferenceTrack, SensorLog
from hostkit.importers.reference import slerp, up_at
from hostkit.importers.rotation import (
    attitude_from_frd,
    from_euler,
    from_frd,
    from_rotation_vector,
    multiply,
    to_rotation_vector,
    to_world,
)
from hostkit.importers.timebase import (
    median_rate_hz,
    require_rising,
    resampled,
    seconds,
    unwrapped,
)
from hostkit.recordings import Recording


def wxyz(rotation: Rotation) -> np.ndarray:
    return np.roll(rotation.as_quat(), 1, axis=-1)


def test_rotations_agree_with_scipy() -> None:
    rng = np.random.default_rng(1)
    a, b = Rotation.random(50, rng=rng), Rotation.random(50, rng=rng)
    vectors = rng.standard_normal((50, 3))
    np.testing.assert_allclose(to_world(wxyz(a), vectors), a.apply(vectors), atol=1e-14)
    product = multiply(wxyz(a), wxyz(b))
    np.testing.assert_allclose(to_world(product, vectors), (a * b).apply(vectors), atol=1e-14)
    turn = 0.9 * a.as_rotvec()
    np.testing.assert_allclose(to_rotation_vector(from_rotation_vector(turn)), turn, atol=1e-14)
    tiny = 1e-12 * vectors
    np.testing.assert_allclose(to_rotation_vector(from_rotation_vector(tiny)), tiny, rtol=1e-12)
    roll, pitch, yaw = rng.uniform(-1.5, 1.5, (3, 50))
    euler = Rotation.from_euler("ZYX", np.column_stack((yaw, pitch, roll)))
    got = to_world(from_euler(roll, pitch, yaw), vectors)
    np.testing.assert_allclose(got, euler.apply(vectors), atol=1e-14)


def test_frd_attitude_shows_the_same_up() -> None:
    rng = np.random.default_rng(2)
    to_ned = Rotation.random(50, rng=rng)
    up_frd = to_ned.inv().apply((0.0, 0.0, -1.0))
    got = up_from_quaternion(attitude_from_frd(wxyz(to_ned)))
    np.testing.assert_allclose(got, from_frd(up_frd), atol=1e-14)


def test_slerp_agrees_with_scipy_whatever_the_signs() -> None:
    rng = np.random.default_rng(3)
    ends = Rotation.random(2, rng=rng)
    share = np.linspace(0.0, 1.0, 21)
    first, second = np.tile(wxyz(ends)[:1], (21, 1)), np.tile(wxyz(ends)[1:], (21, 1))
    expected = Slerp((0.0, 1.0), ends)(share)
    for sign in (1.0, -1.0):
        got = Rotation.from_quat(np.roll(slerp(first, sign * second, share), -1, axis=1))
        assert (got.inv() * expected).magnitude().max() < 1e-7


def test_reference_is_interpolated_and_unknown_in_gaps() -> None:
    track_s = np.array((0.0, 0.1, 0.2, 0.9, 1.0, 1.1))
    attitude = from_euler(track_s, np.zeros(6), np.zeros(6))
    attitude[4] = np.nan
    track = ReferenceTrack(time_s=track_s, quaternion_wxyz=attitude)
    times = np.array((-0.01, 0.0, 0.05, 0.2, 0.3, 0.89, 0.9, 0.95, 1.0, 1.1, 1.2))
    up = up_at(track, times)
    known = np.isfinite(up).all(axis=1)
    assert known.tolist() == [
        False,
        True,
        True,
        True,
        False,
        False,
        True,
        False,
        False,
        True,
        False,
    ]
    roll = np.arctan2(up[known][:, 1], up[known][:, 2])
    np.testing.assert_allclose(roll, times[known], atol=1e-12)


def test_vanishing_quaternions_are_a_lost_reference() -> None:
    attitude = from_euler(np.zeros(3), np.zeros(3), np.zeros(3))
    attitude[1] = 1e-6
    track = ReferenceTrack(time_s=np.arange(3.0), quaternion_wxyz=attitude)
    assert np.isfinite(up_at(track, np.arange(3.0))).all(axis=1).tolist() == [True, False, True]


@pytest.mark.parametrize("times", [(0.0, 0.1, 0.1), (0.0, 0.2, 0.1)])
def test_disorder_in_the_reference_is_named(times: tuple[float, ...]) -> None:
    track = ReferenceTrack(time_s=np.array(times), quaternion_wxyz=np.eye(4)[[0, 0, 0]])
    with pytest.raises(RecordingError, match=r"row 3 of the reference.*--no-reference"):
        up_at(track, np.array((0.0, 0.1)))


def test_disorder_is_named() -> None:
    require_rising(np.array((0.0, 0.1, 0.2)))
    with pytest.raises(RecordingError, match=r"row 3: time 0.1\d* s repeats.*--resample"):
        require_rising(np.array((0.0, 0.1, 0.1)))
    with pytest.raises(RecordingError, match=r"row 2: time -1\.0"):
        require_rising(np.array((0.0, -1.0, 0.2)))
    with pytest.raises(RecordingError, match="row 2: the time is nan"):
        require_rising(np.array((0.0, np.nan, 0.2)))


def test_ticks() -> None:
    late = 1_700_000_000_000_000_000
    ticks = np.array((0, 1, 2), dtype=np.int64) + late
    np.testing.assert_array_equal(seconds(ticks, 1e9, late), (0.0, 1e-9, 2e-9))
    whole, turns = unwrapped(np.array((2.0**32 - 2, 2.0**32 - 1, 0.0, 1.0)))
    np.testing.assert_array_equal(np.diff(whole), 1.0)
    assert turns == 1
    assert median_rate_hz(np.array((0.0, 0.01, 0.02, 0.5))) == 100.0


def burst_log(time_s: np.ndarray, true_s: np.ndarray) -> SensorLog:
    rate = np.column_stack((np.sin(true_s), np.cos(true_s), true_s))
    return SensorLog(
        time_s=time_s, angular_rate_rad_s=rate, specific_force_m_s2=rate + 9.0,
        mag_ut=rate, temperature_deg_c=true_s, valid=true_s < 15.0,
    )  # fmt: skip


def test_bursts_are_evened_out() -> None:
    true_s = np.arange(2000) / 100.0
    arrival_s = np.ceil(true_s / 0.2) * 0.2
    log = burst_log(arrival_s, true_s)
    track = ReferenceTrack(
        time_s=arrival_s, quaternion_wxyz=from_euler(0.1 * true_s, 0 * true_s, 0 * true_s)
    )
    got = resampled(replace(log, reference=track), 50.0)
    assert np.ptp(np.diff(got.time_s)) < 1e-9
    assert got.rate_hz == 50.0
    late = got.angular_rate_rad_s[:, 2] - got.time_s
    inner = slice(60, -60)
    assert np.ptp(late[inner]) < 0.02  # of 0.2 s of delay that varied
    expected = np.column_stack((np.sin(got.temperature_deg_c), np.cos(got.temperature_deg_c)))
    np.testing.assert_allclose(got.angular_rate_rad_s[inner, :2], expected[inner], atol=1e-4)
    assert got.valid is not None
    assert got.reference is not None
    up = up_at(got.reference, got.time_s[inner])
    roll = np.arctan2(up[:, 1], up[:, 2])
    np.testing.assert_allclose(roll, 0.1 * got.temperature_deg_c[inner], atol=1e-9)


def test_even_times_stay_and_pauses_are_left_out() -> None:
    true_s = np.concatenate((np.arange(300) / 100.0, 10.0 + np.arange(300) / 100.0))
    got = resampled(burst_log(true_s, true_s), 100.0)
    np.testing.assert_allclose(got.angular_rate_rad_s[:, 2], true_s, atol=1e-9)
    np.testing.assert_allclose(got.time_s, true_s, atol=1e-9)


@pytest.mark.parametrize(("rate_hz", "message"), [(1e9, "the limit is"), (0.01, "leaves 1 sample")])
def test_grids_that_cannot_be(rate_hz: float, message: str) -> None:
    true_s = np.arange(300) / 100.0
    with pytest.raises(RecordingError, match=message):
        resampled(burst_log(true_s, true_s), rate_hz)


def coned(rate_hz: float, samples: int) -> Recording:
    """A sensor that cones: each rate is exact for the step that ends with it."""
    time_s = np.arange(samples + 1) / rate_hz
    attitude = Rotation.from_euler(
        "ZYX", np.column_stack((3.0 * time_s, 0.9 * np.sin(9.0 * time_s), np.cos(7.0 * time_s)))
    )
    steps = (attitude[:-1].inv() * attitude[1:]).as_rotvec()
    up = attitude[1:].inv().apply((0.0, 0.0, 1.0))
    return Recording(
        name="cone",
        time_s=time_s[1:],
        rate_hz=rate_hz,
        angular_rate_rad_s=steps * rate_hz,
        specific_force_m_s2=9.81 * up,
        valid=np.ones(samples, dtype=bool),
        up_reference=up,
        mag_ut=40.0 * attitude[1:].inv().apply((1.0, 0.0, 0.0)),
        temperature_deg_c=np.arange(samples, dtype=float),
    )


def integrated(recording: Recording) -> Rotation:
    step_s = 1.0 / recording.rate_hz
    total = Rotation.identity()
    for turn in recording.angular_rate_rad_s * step_s:
        total = total * Rotation.from_rotvec(turn)
    return total


@pytest.mark.parametrize("factor", [2, 3, 5])
def test_decimation_composes_rotations(factor: int) -> None:
    full = coned(50.0, 120)
    few = decimated(full, factor)
    assert len(few) == 120 // factor
    assert few.rate_hz == 50.0 / factor
    assert (integrated(few).inv() * integrated(full)).magnitude() < 1e-12
    last = slice(factor - 1, None, factor)
    np.testing.assert_array_equal(few.time_s, full.time_s[last])
    np.testing.assert_array_equal(few.up_reference, full.up_reference[last])
    np.testing.assert_allclose(few.specific_force_m_s2, full.specific_force_m_s2[last], atol=1e-12)
    np.testing.assert_allclose(few.mag_ut, full.mag_ut[last], atol=1e-12)


def test_averaged_rates_would_be_wrong() -> None:
    full = coned(50.0, 120)
    mean = full.angular_rate_rad_s.reshape(-1, 3, 3).mean(axis=1)
    few = replace(decimated(full, 3), angular_rate_rad_s=mean)
    assert (integrated(few).inv() * integrated(full)).magnitude() > np.radians(0.36)


def test_decimated_samples_are_valid_if_all_are() -> None:
    full = coned(50.0, 10)
    flags = np.array([True] * 4 + [False] + [True] * 5)
    few = decimated(replace(full, valid=flags), 3)
    assert few.valid.tolist() == [True, False, True]
    np.testing.assert_allclose(few.temperature_deg_c, (1.0, 4.0, 7.0))
    with pytest.raises(RecordingError, match="leaves 1 of 10 samples"):
        decimated(full, 6)


def test_reference_track_needs_matching_shapes() -> None:
    with pytest.raises(RecordingError, match="3 times"):
        ReferenceTrack(time_s=np.arange(3.0), quaternion_wxyz=np.zeros((2, 4)))
    with pytest.raises(RecordingError, match="3 times"):
        SensorLog(
            time_s=np.arange(3.0),
            angular_rate_rad_s=np.zeros((2, 3)),
            specific_force_m_s2=np.zeros((3, 3)),
        )


def test_up_between_reference_samples_turns_evenly() -> None:
    angle = np.array((0.0, 1.0))
    track = ReferenceTrack(time_s=angle, quaternion_wxyz=from_euler(angle, 0 * angle, 0 * angle))
    up = up_at(track, np.linspace(0.0, 1.0, 11))
    turns = [float(inclination_rad(a, b)) for a, b in pairwise(up)]
    np.testing.assert_allclose(turns, 0.1, atol=1e-12)
