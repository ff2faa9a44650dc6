from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from boards import RESTARTED, SATURATED, generated, hear, require_or_skip, stimulus
from designs import design

from hostkit.attitude import up_from_tilt
from hostkit.design_file import digest
from hostkit.emulation import host_board
from hostkit.emulation.board import Stimulus
from hostkit.mounting import Mounting
from hostkit.units import RAD_PER_HALF_TURN_LSB, STANDARD_GRAVITY_M_S2

N = 40


def at_rest(roll_rad: float, pitch_rad: float, rate_rad_s: tuple[float, float, float]) -> Stimulus:
    """Sensor axes are body axes."""
    up = up_from_tilt(np.full(N, roll_rad), np.full(N, pitch_rad))
    return replace(
        stimulus(N),
        angular_rate_rad_s=np.tile(np.array(rate_rad_s), (N, 1)),
        specific_force_m_s2=up * STANDARD_GRAVITY_M_S2,
    )


def test_nothing_but_what_is_planned(host_folder: Path) -> None:
    heard = hear(host_board.run(host_folder, stimulus(100)))
    planned = {"HEARTBEAT", "SYS_STATUS", "ATTITUDE", "TILT_SAMPLE"}
    assert {frame.name for frame in heard.frames} == planned
    assert {frame.source for frame in heard.frames} == {(1, 1)}
    assert len(heard.of("ATTITUDE")) == 50
    assert len(heard.of("TILT_SAMPLE")) == 100


def test_heartbeat_is_generic_and_once_a_second(host_folder: Path) -> None:
    heartbeats = hear(host_board.run(host_folder, stimulus(500))).of("HEARTBEAT")
    assert {(h.type, h.autopilot, h.base_mode, h.custom_mode) for h in heartbeats} == {(0, 0, 0, 0)}
    assert 6 <= len(heartbeats) <= 8


def test_design_digest_is_in_every_sample(host_folder: Path) -> None:
    samples = hear(host_board.run(host_folder, stimulus(20))).samples
    assert {bytes(s.digest).hex() for s in samples} == {digest(design())}


def test_flags(host_folder: Path) -> None:
    feels = stimulus(400)
    samples = hear(host_board.run(host_folder, feels)).samples
    for s in samples:
        counts = np.array([*s.accel, *s.gyro])
        saturated = bool(((counts >= 32767) | (counts <= -32767)).any())
        assert bool(s.flags & SATURATED) == saturated
        assert bool(s.flags & RESTARTED) == (s.sequence == 0)
    assert any(s.flags & SATURATED for s in samples)
    assert not all(s.flags & SATURATED for s in samples)


@pytest.mark.parametrize(
    ("roll", "pitch"), [(0.0, 0.0), (0.5, 0.0), (0.0, 0.4), (-1.2, 0.3), (2.9, -0.7)]
)
def test_attitude_is_forward_right_down(host_folder: Path, roll: float, pitch: float) -> None:
    """Left side up is roll to the right, positive in both; nose down is a negative MAVLink pitch.

    The oracle is a rotation of the vectors themselves, not of the angles: half a turn about x takes
    forward-left-up to forward-right-down, in which gravity at rest is (-sin p, sin r cos p, cos r
    cos p) times g with MAVLink's angles.
    """
    feels = at_rest(roll, pitch, (0.0, 0.0, 0.0))
    message = hear(host_board.run(host_folder, feels)).of("ATTITUDE")[0]
    force = feels.specific_force_m_s2[0] / STANDARD_GRAVITY_M_S2
    down_frd = -force * [1.0, -1.0, -1.0]
    r, p = message.roll, message.pitch
    wanted = [-np.sin(p), np.sin(r) * np.cos(p), np.cos(r) * np.cos(p)]
    np.testing.assert_allclose(down_frd, wanted, atol=1e-3)
    assert message.yaw == 0.0


def test_attitude_rates_are_forward_right_down(host_folder: Path) -> None:
    feels = at_rest(0.0, 0.0, (0.3, 0.2, 0.1))
    message = hear(host_board.run(host_folder, feels)).of("ATTITUDE")[0]
    rates = (message.rollspeed, message.pitchspeed, message.yawspeed)
    assert rates == pytest.approx((0.3, -0.2, -0.1), abs=2e-4)


def test_attitude_agrees_with_the_sample_before_it(host_folder: Path) -> None:
    frames = hear(host_board.run(host_folder, stimulus(100))).frames
    pairs = [
        (a.message, b.message)
        for a, b in pairwise(frames)
        if (a.name, b.name) == ("TILT_SAMPLE", "ATTITUDE")
    ]
    assert len(pairs) == 50
    for sample, attitude in pairs:
        assert attitude.roll == pytest.approx(sample.roll * RAD_PER_HALF_TURN_LSB, abs=1e-6)
        assert attitude.pitch == pytest.approx(-sample.pitch * RAD_PER_HALF_TURN_LSB, abs=1e-6)
        assert attitude.time_boot_ms == sample.time_usec // 1000


@pytest.mark.parametrize("mounting", ["+z+x+y", "-y+x+z", "+x-y-z"])
def test_mounting_applies_to_the_rates(tmp_path: Path, mounting: str) -> None:
    require_or_skip("gcc", "make")
    code = design(mounting=mounting)
    folder = generated("host", tmp_path / "code", code)
    host_board.build(folder, sanitize=True)
    body = np.array([0.3, 0.2, 0.1])
    parsed = Mounting.parse(mounting)
    sensor = np.zeros(3)
    sensor[list(parsed.source)] = body * parsed.sign
    feels = replace(stimulus(N), angular_rate_rad_s=np.tile(sensor, (N, 1)))
    message = hear(host_board.run(folder, feels)).of("ATTITUDE")[0]
    rates = (message.rollspeed, message.pitchspeed, message.yawspeed)
    assert rates == pytest.approx((0.3, -0.2, -0.1), abs=2e-4)


def test_a_count_at_the_end_of_the_range_may_be_turned_round(tmp_path: Path) -> None:
    """-(-32768) is no int16: the sanitizer would stop the program."""
    require_or_skip("gcc", "make")
    code = design(mounting="-x-y+z")
    folder = generated("host", tmp_path / "code", code)
    host_board.build(folder, sanitize=True)
    feels = replace(
        stimulus(N),
        angular_rate_rad_s=np.full((N, 3), -1e3),
        specific_force_m_s2=np.full((N, 3), -1e3),
    )
    heard = hear(host_board.run(folder, feels))
    assert {tuple(s.gyro) for s in heard.samples} == {(-32768, -32768, -32768)}
    assert heard.of("ATTITUDE")[0].rollspeed > 0.0
