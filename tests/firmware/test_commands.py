"""Commands, time and ping, spoken with the host firmware by pymavlink."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from boards import hear, stimulus, with_faults
from designs import design
from ground import (
    ACCEPTED,
    DENIED,
    FAILED,
    GROUND,
    IN_PROGRESS,
    TEMPORARILY_REJECTED,
    UNSUPPORTED,
    Ground,
    M,
    acks,
    resting,
    texts,
    values,
)

from hostkit import __version__
from hostkit.design_file import digest
from hostkit.emulation.board import PlannedFault
from hostkit.emulation.fault import KINDS

INTERVAL, REQUEST, CALIBRATE, STORE, REBOOT = 511, 512, 241, 245, 246
SCALED_IMU, RAW_IMU, ATTITUDE, HIGHRES_IMU = 26, 27, 30, 105
CALIBRATING, ACTIVE = 2, 4


@pytest.mark.parametrize("number", [0, 1, 22, 400, 520, 42424, 65535])
def test_what_is_not_known_is_answered_too(host_folder: Path, number: int) -> None:
    ground = Ground()
    ground.command(0.5, number, 1)
    heard = ground.run(host_folder, stimulus(100))
    assert acks(heard) == [(number, UNSUPPORTED)]
    (ack,) = heard.of("COMMAND_ACK")
    assert (ack.target_system, ack.target_component) == GROUND


def test_an_interval_is_kept_and_the_default_comes_back(host_folder: Path) -> None:
    ground = Ground()
    ground.command(1.0, INTERVAL, RAW_IMU, 20_000)
    ground.command(2.0, INTERVAL, ATTITUDE, -1)
    ground.command(3.0, INTERVAL, ATTITUDE, 0)
    ground.command(3.0, INTERVAL, RAW_IMU, 0)
    heard = ground.run(host_folder, stimulus(400))
    assert acks(heard) == [(INTERVAL, ACCEPTED)] * 4
    raw_us = [m.time_usec for m in heard.of("RAW_IMU")]
    assert set(np.diff(raw_us)) == {20_000}
    assert (raw_us[-1] - raw_us[0]) / 1e6 == pytest.approx(2.0, abs=0.05)
    ms = np.array([m.time_boot_ms for m in heard.of("ATTITUDE")])
    assert not ((ms > 2020) & (ms < 2990)).any()
    assert (ms > 3020).any()


@pytest.mark.parametrize(
    ("message", "interval", "result"),
    [
        (999, 10_000, UNSUPPORTED),
        (-5, 10_000, UNSUPPORTED),
        (float("nan"), 10_000, UNSUPPORTED),
        (1e30, 10_000, UNSUPPORTED),
        (RAW_IMU, -2, DENIED),
        (RAW_IMU, float("nan"), DENIED),
        (RAW_IMU, float("inf"), DENIED),
        (RAW_IMU, 1e12, DENIED),
        (0, -1, DENIED),
        (0, 1e7, DENIED),
        (0, 500_000, ACCEPTED),
    ],
)
def test_odd_intervals(host_folder: Path, message: float, interval: float, result: int) -> None:
    ground = Ground()
    ground.command(0.5, INTERVAL, message, interval)
    assert acks(ground.run(host_folder, stimulus(100))) == [(INTERVAL, result)]


@pytest.mark.parametrize(
    ("number", "name"),
    [(26, "SCALED_IMU"), (27, "RAW_IMU"), (105, "HIGHRES_IMU"), (148, "AUTOPILOT_VERSION")],
)
def test_a_message_is_sent_once_on_request(host_folder: Path, number: int, name: str) -> None:
    ground = Ground()
    ground.command(1.0, REQUEST, number)
    heard = ground.run(host_folder, stimulus(200))
    assert acks(heard) == [(REQUEST, ACCEPTED)]
    assert len(heard.of(name)) == 1


def test_requests_that_cannot_be_met(host_folder: Path) -> None:
    ground = Ground()
    ground.command(0.05, REQUEST, RAW_IMU)  # before the first sample
    ground.command(0.06, REQUEST, 12345)
    heard = ground.run(host_folder, stimulus(100))
    assert acks(heard) == [(REQUEST, TEMPORARILY_REJECTED), (REQUEST, UNSUPPORTED)]
    assert heard.of("RAW_IMU") == []


def test_version_and_design_are_told(host_folder: Path) -> None:
    ground = Ground()
    ground.command(0.5, REQUEST, 148)
    (version,) = ground.run(host_folder, stimulus(100)).of("AUTOPILOT_VERSION")
    assert version.capabilities == 8192 + 131072
    assert bytes(version.flight_custom_version)[:6].hex() == digest(design())
    number = version.flight_sw_version.to_bytes(4, "big")
    assert ".".join(map(str, number[:3])) == __version__


def test_the_three_views_of_a_sample_agree(host_folder: Path) -> None:
    ground = Ground()
    for number in (SCALED_IMU, RAW_IMU, HIGHRES_IMU):
        ground.command(0.05, INTERVAL, number, 10_000)
    heard = ground.run(host_folder, stimulus(100))
    rows = zip(
        *(heard.of(n) for n in ("TILT_SAMPLE", "SCALED_IMU", "RAW_IMU", "HIGHRES_IMU")), strict=True
    )
    seen = 0
    for sample, scaled, raw, high in rows:
        seen += 1
        assert [raw.xacc, raw.yacc, raw.zacc] == sample.accel
        assert [raw.xgyro, raw.ygyro, raw.zgyro] == sample.gyro
        assert raw.time_usec == sample.time_usec == high.time_usec
        force = np.array(sample.accel) * [1, -1, -1] / 16384
        np.testing.assert_allclose([high.xacc, high.yacc, high.zacc], force * 9.80665, rtol=1e-6)
        np.testing.assert_allclose([scaled.xacc, scaled.yacc, scaled.zacc], force * 1000, atol=0.51)
        rate = np.radians(np.array(sample.gyro) * [1, -1, -1] / 65.5)
        np.testing.assert_allclose([high.xgyro, high.ygyro, high.zgyro], rate, rtol=2e-3)
        np.testing.assert_allclose(
            [scaled.xgyro, scaled.ygyro, scaled.zgyro],
            np.array([high.xgyro, high.ygyro, high.zgyro]) * 1000,
            atol=0.51,
        )
        celsius = sample.temperature / 340 + 36.53
        assert raw.temperature == pytest.approx(100 * celsius, abs=1.01)
        assert scaled.temperature == raw.temperature or raw.temperature == 0
        assert high.temperature == pytest.approx(celsius, abs=0.011)
        assert high.fields_updated == 0b1000000111111
    assert seen == 100


def test_timesync_is_answered_in_nanoseconds(host_folder: Path) -> None:
    ground = Ground()
    ground.send(0.0, M.MAVLink_timesync_message(0, 5))
    ground.send(1.25, M.MAVLink_timesync_message(0, -(2**62)))
    ground.send(1.5, M.MAVLink_timesync_message(77, 5))  # an answer, not a question
    first, second = ground.run(host_folder, stimulus(200)).of("TIMESYNC")
    assert (first.ts1, second.ts1) == (5, -(2**62))
    assert 0 < first.tc1 < 50_000_000
    assert second.tc1 == pytest.approx(1.25e9, abs=2e7)


def test_ping_is_answered_to_the_one_who_asked(host_folder: Path) -> None:
    ground = Ground()
    ground.send(0.5, M.MAVLink_ping_message(123456789, 17, 0, 0))
    ground.send(0.6, M.MAVLink_ping_message(1, 18, 1, 1))  # somebody's answer to us
    (ping,) = ground.run(host_folder, stimulus(100)).of("PING")
    assert (ping.time_usec, ping.seq) == (123456789, 17)
    assert (ping.target_system, ping.target_component) == GROUND


def test_streams_are_not_slowed_down_by_the_old_request(host_folder: Path) -> None:
    """MAVProxy sends REQUEST_DATA_STREAM, all streams at 4 Hz, to everybody."""
    payload = bytes([4, 0, 1, 1, 0, 1])
    header = bytes([len(payload), 0, 0, 0, *GROUND, 66, 0, 0])
    from pymavlink.generator.mavcrc import x25crc

    crc = x25crc(header + payload + bytes([148])).crc
    ground = Ground()
    ground.raw(0.5, b"\xfd" + header + payload + crc.to_bytes(2, "little"))
    heard = ground.run(host_folder, stimulus(200))
    assert len(heard.samples) == 200
    assert len(heard.of("ATTITUDE")) == 100
    assert heard.of("COMMAND_ACK") == []


def test_the_health_of_the_sensor_is_told(host_folder: Path) -> None:
    good = Ground().run(host_folder, stimulus(300)).of("SYS_STATUS")
    assert {s.onboard_control_sensors_present for s in good} == {3}
    assert [s.onboard_control_sensors_health for s in good][1:] == [3] * (len(good) - 1)
    assert all(0 < s.load < 1000 for s in good[1:])
    bad = Ground().run(host_folder, with_faults(stimulus(300), who_am_i=0x12)).of("SYS_STATUS")
    assert {s.onboard_control_sensors_health for s in bad} == {0}
    ground = Ground()
    frame = bytearray(ground.frame(M.MAVLink_ping_message(1, 2, 0, 0)))
    frame[-1] ^= 1
    ground.raw(0.5, bytes(frame))
    assert ground.run(host_folder, stimulus(300)).of("SYS_STATUS")[-1].errors_comm == 1


# --- Calibration ------------------------------------------------------------------------------

BIAS_RAD_S = (0.03, -0.02, 0.01)


def test_a_still_sensor_is_calibrated_on_command(host_folder: Path) -> None:
    ground = Ground()
    ground.command(1.0, CALIBRATE, 1)
    heard = ground.run(host_folder, resting(400, BIAS_RAD_S))
    assert acks(heard) == [(CALIBRATE, IN_PROGRESS), (CALIBRATE, ACCEPTED)]
    assert texts(heard) == ["Gyroscope calibrated"]
    assert CALIBRATING in heard.states
    assert heard.states[-1] == ACTIVE
    found = dict(values(heard))
    assert found["GYRO_BIAS_ROLL"] == pytest.approx(BIAS_RAD_S[0], abs=3e-4)
    assert found["GYRO_BIAS_PITCH"] == pytest.approx(BIAS_RAD_S[1], abs=3e-4)
    assert all(s.flags & 4 for s in heard.samples[-100:])
    assert [s.sequence for s in heard.samples] == list(range(400)), "samples go on meanwhile"


def test_a_calibration_is_kept(host_folder: Path) -> None:
    ground = Ground()
    ground.command(1.0, CALIBRATE, 1)
    run = ground.board_run(host_folder, resting(800, BIAS_RAD_S))
    later = Ground()
    later.read(0.5, "GYRO_BIAS_ROLL")
    again = later.run(host_folder, resting(100), store=run.store)
    assert values(again)[-1] == [v for v in values(hear(run)) if v[0] == "GYRO_BIAS_ROLL"][-1]


def test_a_moving_sensor_is_not_calibrated(host_folder: Path) -> None:
    ground = Ground()
    ground.command(1.0, CALIBRATE, 1)
    ground.command(2.0, CALIBRATE, 1)  # one at a time
    heard = ground.run(host_folder, stimulus(1300))
    assert acks(heard) == [
        (CALIBRATE, IN_PROGRESS),
        (CALIBRATE, TEMPORARILY_REJECTED),
        (CALIBRATE, FAILED),
    ]
    assert texts(heard) == ["Gyroscope not calibrated: it moves"]
    assert values(heard) == []
    assert not any(s.flags & 4 for s in heard.samples)


def test_what_does_not_measure_is_not_calibrated(host_folder: Path) -> None:
    ground = Ground()
    ground.command(2.0, CALIBRATE, 1)
    heard = ground.run(host_folder, with_faults(stimulus(300), who_am_i=0x12))
    assert acks(heard) == [(CALIBRATE, TEMPORARILY_REJECTED)]


@pytest.mark.parametrize("asked", [(0,), (0, 0, 0, 0, 1), (2,), (1, 0, 0, 0, 1)])
def test_other_calibrations_are_not_pretended(host_folder: Path, asked: tuple[float, ...]) -> None:
    ground = Ground()
    ground.command(1.0, CALIBRATE, *asked)
    assert acks(ground.run(host_folder, resting(200))) == [(CALIBRATE, UNSUPPORTED)]


def test_calibration_at_the_start_on_request(host_folder: Path) -> None:
    ground = Ground()
    ground.set(0.5, "CAL_START", 1)
    first = ground.board_run(host_folder, resting(600, BIAS_RAD_S))
    assert texts(hear(first)) == []
    second = Ground().board_run(host_folder, resting(700, BIAS_RAD_S), store=first.store)
    heard = hear(second)
    assert texts(heard) == ["Gyroscope calibrated"]
    assert CALIBRATING in heard.states
    assert dict(values(heard))["GYRO_BIAS_ROLL"] == pytest.approx(BIAS_RAD_S[0], abs=3e-4)
    assert second.store == first.store, "what every start finds anew is not stored"


# --- Reboot -----------------------------------------------------------------------------------


def test_reboot_on_command_after_the_answer(host_folder: Path) -> None:
    ground = Ground()
    ground.command(1.0, REBOOT, 1)
    run = ground.board_run(host_folder, resting(300))
    heard = hear(run)
    assert acks(heard) == [(REBOOT, ACCEPTED)]
    assert dict(run.faults)["resets"] == 1
    sequences = [s.sequence for s in heard.samples]
    assert sequences.count(0) == 2
    assert len(sequences) == 300, "no row is lost on the way"


@pytest.mark.parametrize("what", [0, 2, 3])
def test_nothing_else_is_shut_down(host_folder: Path, what: int) -> None:
    ground = Ground()
    ground.command(1.0, REBOOT, what)
    run = ground.board_run(host_folder, resting(200))
    assert acks(hear(run)) == [(REBOOT, UNSUPPORTED)]
    assert "resets" not in dict(run.faults)


@pytest.mark.parametrize("what", [-1, 3, 0.5])
def test_odd_ways_to_store_are_denied(host_folder: Path, what: float) -> None:
    ground = Ground()
    ground.command(1.0, STORE, what)
    assert acks(ground.run(host_folder, resting(200))) == [(STORE, DENIED)]


# --- Self-test --------------------------------------------------------------------------------

SELF_TEST = 31010
FAULTS = [kind.name for kind in KINDS]


@pytest.mark.parametrize(
    ("fault", "amount", "result", "text"),
    [
        (None, 0, ACCEPTED, "Self-test passed"),
        ("weak-response", 50, FAILED, "Self-test failed"),
        ("no-trim", 0, FAILED, "Self-test has no factory figures"),
    ],
)
def test_the_result_of_a_self_test_is_told(
    host_folder: Path, fault: str | None, amount: int, result: int, text: str
) -> None:
    ground = Ground()
    ground.command(1.0, SELF_TEST)
    ground.command(1.1, SELF_TEST)  # one at a time
    feels = resting(600)
    if fault is not None:
        planned = (PlannedFault(code=FAULTS.index(fault), row=10, amount=amount),)
        feels = replace(feels, faults=replace(feels.faults, planned=planned))
    heard = ground.run(host_folder, feels)
    assert acks(heard) == [
        (SELF_TEST, IN_PROGRESS),
        (SELF_TEST, TEMPORARILY_REJECTED),
        (SELF_TEST, result),
    ]
    assert texts(heard) == [text]
    assert CALIBRATING in heard.states
    assert heard.states[-1] == ACTIVE
    assert len(heard.samples) > 300


def test_a_sensor_that_does_not_run_is_not_tested(host_folder: Path) -> None:
    ground = Ground()
    ground.command(2.0, SELF_TEST)
    heard = ground.run(host_folder, with_faults(stimulus(300), who_am_i=0x12))
    assert acks(heard) == [(SELF_TEST, TEMPORARILY_REJECTED)]
