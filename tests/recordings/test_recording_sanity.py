import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from hostkit.attitude import up_from_tilt
from hostkit.errors import RecordingError
from hostkit.recordings import Recording, check, load, save
from hostkit.recordings.sanity.agreement import agreement
from hostkit.recordings.sanity.clipping import clips
from hostkit.units import DEG_PER_RAD, STANDARD_GRAVITY_M_S2

Make = Callable[..., Recording]


def kinds(recording: Recording) -> set[str]:
    return {finding.kind for finding in check(recording).findings}


def message(recording: Recording, kind: str) -> str:
    (found,) = [f.message for f in check(recording).findings if f.kind == kind]
    return found


def scaled(recording: Recording, rate: float = 1.0, force: float = 1.0) -> Recording:
    return replace(
        recording,
        angular_rate_rad_s=recording.angular_rate_rad_s * rate,
        specific_force_m_s2=recording.specific_force_m_s2 * force,
    )


@pytest.mark.parametrize("profile", ["rest", "sine-sweep", "steps", "random", "free"])
def test_a_sound_recording_has_no_warnings(make: Make, profile: str) -> None:
    card = check(make(profile))
    assert card.findings == ()
    assert card.lines()[-1] == "no warnings"
    assert card.lines()[0].startswith("time: 3000 samples at 100 Hz, 29.99 s; steps 10 / 10 / 10")


# --- hard faults ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("factor", "hint"),
    [
        (1.0 / STANDARD_GRAVITY_M_S2, "it looks like g: multiply it by 9.80665"),
        (1000.0 / STANDARD_GRAVITY_M_S2, "it looks like mg: multiply it by 0.00980665"),
        (16384.0 / STANDARD_GRAVITY_M_S2, r"counts at \+-2 g"),
        (8192.0 / STANDARD_GRAVITY_M_S2, r"counts at \+-4 g"),
        (4096.0 / STANDARD_GRAVITY_M_S2, r"counts at \+-8 g"),
        (2048.0 / STANDARD_GRAVITY_M_S2, r"counts at \+-16 g"),
        (0.02, "has gravity been taken out"),
        (10.0, r"limits 5 to 20\): bring it to m/s\^2"),
    ],
)
def test_force_in_another_unit(make: Make, factor: float, hint: str) -> None:
    with pytest.raises(RecordingError, match=hint):
        check(scaled(make(), force=factor))


def test_rate_beyond_any_gyroscope(make: Make) -> None:
    rate = make().angular_rate_rad_s.copy()
    rate[41, 1] = -70.5
    with pytest.raises(RecordingError, match=r"row 42: .* about y is 70\.5 rad/s; .* beyond 70"):
        check(make(angular_rate_rad_s=rate))
    rate[41, 1] = 69.5
    check(make(angular_rate_rad_s=rate))


@pytest.mark.parametrize("profile", ["sine-sweep", "steps", "random", "free"])
def test_rate_in_degrees_at_slow_motion(make: Make, profile: str) -> None:
    slow = replace(make(profile), time_s=make(profile).time_s * 8.0, rate_hz=12.5)
    slow = scaled(slow, rate=1.0 / 8.0)
    assert kinds(slow) == set()
    with pytest.raises(RecordingError, match=r"5\d(\.\d+)? times .* in deg/s: multiply it by pi/"):
        check(scaled(slow, rate=DEG_PER_RAD))


def test_rate_converted_twice(make: Make) -> None:
    with pytest.raises(RecordingError, match=r"multiplied by pi/180 twice"):
        check(scaled(make(), rate=1.0 / DEG_PER_RAD))


def test_time_in_milliseconds_called_seconds(make: Make) -> None:
    with pytest.raises(RecordingError, match="the time is in ms"):
        check(make(time_s=make().time_s * 1000.0, rate_hz=0.1))


def test_time_in_milliseconds_called_microseconds(make: Make) -> None:
    with pytest.raises(RecordingError, match=r"100000 Hz; sensors deliver 0\.1 to 8000 Hz"):
        check(make(time_s=make().time_s / 1000.0))


def test_nominal_rate_in_another_unit(make: Make) -> None:
    with pytest.raises(RecordingError, match=r"rate_hz = 10000 but the time stamps make 100 Hz"):
        check(make(rate_hz=10_000.0))


def test_wrapped_counter(make: Make) -> None:
    time_s = make().time_s.copy()
    time_s[100:] -= 2**32 * 1e-6
    with pytest.raises(
        RecordingError, match=r"row 101: .* 32-bit microsecond counter wrapped: add"
    ):
        check(make(time_s=time_s))


def test_reference_of_wrong_length(make: Make) -> None:
    up = make().up_reference.copy()
    up[5] *= 1.1
    with pytest.raises(RecordingError, match=r"row 6: the reference up direction has length 1\.1"):
        check(make(up_reference=up))


def test_load_refuses_hard_faults(tmp_path: Path, make: Make) -> None:
    save(scaled(make(), force=0.1), tmp_path / "g.npz")
    with pytest.raises(RecordingError, match=r"g\.npz: .* it looks like g"):
        load(tmp_path / "g.npz")


# --- findings ------------------------------------------------------------------------------------


def test_gap(make: Make) -> None:
    time_s = make().time_s.copy()
    time_s[1000:] += 0.5
    found = message(make(time_s=time_s), "gap")
    assert found.startswith("1 gap(s), the first before row 1001: 0.51 s without a sample")
    time_s = make().time_s.copy()
    time_s[1000:] += 0.014
    assert "gap" not in kinds(make(time_s=time_s))


def test_jitter(make: Make) -> None:
    noise = np.random.default_rng(1).uniform(-1.0, 1.0, 3000)
    assert kinds(make(time_s=make().time_s + 4e-4 * noise)) == set()
    found = message(make(time_s=make().time_s + 3e-3 * noise), "jitter")
    assert found.startswith("time steps spread by 24")
    assert "; limit 5 %)" in found


def test_nominal_rate(make: Make) -> None:
    assert "rate" not in kinds(make(rate_hz=100.9))
    assert message(make(rate_hz=102.0), "rate").startswith(
        "rate_hz = 102 but the median time step makes 100 Hz, +2 % apart (limit 1 %)"
    )


def test_repeated_values(make: Make) -> None:
    force = make().specific_force_m_s2.copy()
    force[1::2] = force[::2]
    found = message(make(specific_force_m_s2=force), "held")
    assert found.startswith("the specific force repeats: each value stands in 2 rows")
    frozen = message(make("rest", angular_rate_rad_s=np.zeros((3000, 3))), "held")
    assert frozen.startswith("the angular rate is the same in all 3000 rows")


def test_rounding_at_rest_is_no_repetition(make: Make) -> None:
    still = make("rest")
    rate = np.round(still.angular_rate_rad_s, 2)
    assert kinds(replace(still, angular_rate_rad_s=rate)) == set()


@pytest.mark.parametrize(("axis", "limit"), [(0, 2.0), (1, 1.0), (2, 1.5)])
def test_clipped_gyroscope(make: Make, axis: int, limit: float) -> None:
    rate = make().angular_rate_rad_s.copy()
    rate[:, axis] = np.clip(rate[:, axis], -limit, np.inf)
    found = message(make(angular_rate_rad_s=rate), "clipping")
    row = int(np.flatnonzero(rate[:, axis] == -limit)[0]) + 1
    assert found.startswith(f"gyro {'xyz'[axis]} stays at {-limit:g} rad/s for ")
    assert row <= int(found.split("first at row ")[1].split(";")[0]) <= row + 200


def test_clipped_accelerometer(make: Make) -> None:
    force = np.clip(4.0 * make().specific_force_m_s2, -19.6, 19.6)
    assert {clip.value for clip in clips(force, 10.0)} == {-19.6, 19.6}


def test_smooth_peaks_are_not_clipping() -> None:
    time_s = np.arange(10_000) / 100.0
    sine = 3.0 * np.sin(2.0 * np.pi * 0.31 * time_s)
    assert clips(np.stack((sine, np.round(sine, 2), np.abs(sine)), axis=1), 0.5) == ()


@pytest.mark.parametrize("profile", ["random", "free", "steps", "sine-sweep"])
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_flipped_gyro_axis(make: Make, profile: str, axis: int) -> None:
    sign = np.ones(3)
    sign[axis] = -1.0
    recording = make(profile)
    judged = agreement(recording).judged[axis]
    flipped = replace(recording, angular_rate_rad_s=recording.angular_rate_rad_s * sign)
    if not judged:
        assert axis == 2, "roll and pitch move in every profile"
        return
    assert message(flipped, "sign").startswith(f"gyro {'xyz'[axis]} turn(s) against")


def test_all_axes_are_judged_in_free_motion(make: Make) -> None:
    assert agreement(make("free")).judged == (True, True, True)
    assert agreement(make("rest")).judged == (False, False, False)
    assert agreement(make("rest")).scale is None


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_flipped_accelerometer_axis(make: Make, axis: int) -> None:
    sign = np.ones(3)
    sign[axis] = -1.0
    found = message(make(specific_force_m_s2=make().specific_force_m_s2 * sign), "sign")
    others = " and ".join(a for a in "xyz" if a != "xyz"[axis])
    assert f"negate gyro {others}, or accel {'xyz'[axis]}" in found


def test_all_gyro_axes_flipped(make: Make) -> None:
    assert "negate all three gyro axes" in message(scaled(make(), rate=-1.0), "sign")


def test_accelerometer_upside_down_is_seen_by_the_reference(make: Make) -> None:
    found = message(scaled(make("steps"), force=-1.0), "reference")
    assert "deg from the accelerometer (limit 10 deg)" in found


def test_bias_at_rest(make: Make) -> None:
    biased = make("steps").angular_rate_rad_s + np.array((0.0, -1.5, 0.5)) / DEG_PER_RAD
    found = message(make("steps", angular_rate_rad_s=biased), "bias")
    assert re.match(r"gyro y reads -1\.\d+ deg/s at rest \(limit 1 deg/s, \d+ s at rest", found)
    assert float(found.split()[3]) == pytest.approx(-1.7, abs=0.05)
    assert float(found.split("subtract ")[1].split()[0]) == pytest.approx(-0.0297, abs=0.001)


def test_slow_tilting_is_no_rest(make: Make) -> None:
    """A slow swing moves little within a second, and its rate is no bias."""
    recording = make("sine-sweep")
    slow = replace(recording, time_s=8.0 * recording.time_s, rate_hz=12.5)
    slow = replace(slow, angular_rate_rad_s=recording.angular_rate_rad_s / 8.0)
    assert "bias" not in kinds(slow)


def test_steady_turn_is_no_bias(make: Make) -> None:
    recording = make("rest")
    rate = recording.angular_rate_rad_s.copy()
    rate[500:2500, 2] += 0.3
    assert "bias" not in kinds(replace(recording, angular_rate_rad_s=rate))


def test_force_at_rest(make: Make) -> None:
    found = message(scaled(make("rest"), force=1.04), "force")
    assert "m/s^2, +" in found
    assert "(limit 3 %)" in found
    assert "force" not in kinds(scaled(make("rest"), force=1.005))


def test_no_reference(make: Make) -> None:
    assert "there is no reference" in message(make(up_reference=None), "reference")
    lost = np.full((3000, 3), np.nan)
    assert "there is no reference" in message(make(up_reference=lost), "reference")


def test_few_valid_samples(make: Make) -> None:
    valid = np.arange(3000) < 200
    assert message(make(valid=valid), "valid").startswith("6.67 % of the samples are valid")


def test_shortest_recording(make: Make) -> None:
    two = Recording(
        name="two",
        time_s=np.array((0.0, 0.01)),
        rate_hz=100.0,
        angular_rate_rad_s=np.zeros((2, 3)),
        specific_force_m_s2=9.8 * up_from_tilt(np.zeros(2), np.zeros(2)),
        valid=np.ones(2, dtype=np.bool_),
    )
    assert "held" in kinds(two)


@pytest.mark.filterwarnings("error")
def test_free_fall_samples_do_not_hurt(make: Make) -> None:
    force = make().specific_force_m_s2.copy()
    force[100:110] = 0.0
    assert "sign" not in kinds(make(specific_force_m_s2=force))
