"""Parameters, streams, calibration and receiver, each by itself."""

import random
from pathlib import Path

import numpy as np
import pytest
from bench import DONE, MOVED, STILL, Bench, Calibration, Receiver, Streams
from designs import all_parameters, design
from pymavlink.generator.mavcrc import x25crc

from hostkit.dialect import python_module
from hostkit.units import STANDARD_GRAVITY_M_S2

PERIOD_US = 10_000
TILT_SAMPLE, ATTITUDE, HEARTBEAT = "TILT_SAMPLE", "ATTITUDE", "HEARTBEAT"
RAW_IMU, HIGHRES_IMU = "RAW_IMU", "HIGHRES_IMU"
NAMES = [
    *("SYS_ID", "CAL_START", "FILT_TAU"),
    *("GYRO_BIAS_ROLL", "TILT_OFS_ROLL", "GYRO_BIAS_PITCH", "TILT_OFS_PITCH"),
]


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Bench:
    return Bench(tmp_path_factory.mktemp("bench"))


@pytest.fixture(scope="module")
def roll_bench(tmp_path_factory: pytest.TempPathFactory) -> Bench:
    return Bench(tmp_path_factory.mktemp("roll"), all_parameters("roll"))


# --- Parameters -------------------------------------------------------------------------------


def test_names_are_found_in_their_order(bench: Bench) -> None:
    assert [bench.place(name) for name in NAMES] == list(range(len(NAMES)))
    for wrong in ("", "SYS", "SYS_ID2", "sys_id", "GYRO_BIAS_PITCHX", "X" * 16):
        assert bench.place(wrong) == bench.c.HK_NO_PARAMETER


def test_only_axes_of_the_design_have_parameters(roll_bench: Bench) -> None:
    assert roll_bench.place("GYRO_BIAS_ROLL") != roll_bench.c.HK_NO_PARAMETER
    assert roll_bench.place("GYRO_BIAS_PITCH") == roll_bench.c.HK_NO_PARAMETER


@pytest.mark.parametrize(
    ("name", "good", "bad"),
    [
        ("SYS_ID", (1, 2, 249, 251, 254), (0, -1, 250, 255, 256, 1.5, 1e30)),
        ("CAL_START", (0, 1), (-1, 2, 0.5, 1e-3)),
        ("FILT_TAU", (0.5, 2.0, 10.0), (0, -1, 1e30)),
        ("GYRO_BIAS_PITCH", (0, 0.01, -0.05), (1e30, -1e30)),
        ("TILT_OFS_ROLL", (0, 0.1, -0.1), (1e30, -1e30)),
    ],
)
def test_limits(bench: Bench, name: str, good: tuple[float, ...], bad: tuple[float, ...]) -> None:
    design_value = bench.set(name, float("nan"))[1]
    for value in good:
        taken, used, _ = bench.set(name, value)
        assert taken
        assert used == pytest.approx(value, rel=1e-4, abs=1e-6)
    for value in (*bad, float("nan"), float("inf"), -float("inf")):
        assert bench.set(name, value) == (False, design_value, False)


def test_the_value_in_use_is_a_fixed_point(bench: Bench) -> None:
    for value in (0.7, 1.0, 2.8471, 9.99):
        used = bench.set("FILT_TAU", value)[1]
        assert bench.set("FILT_TAU", used)[1] == used


def test_retuned_is_a_filter_that_differs_from_the_design(bench: Bench) -> None:
    tau = bench.set("FILT_TAU", float("nan"))[1]
    assert bench.set("FILT_TAU", tau) == (True, tau, False)
    assert bench.set("FILT_TAU", 1.0)[2]
    assert bench.set("TILT_OFS_ROLL", 0.01)[2]
    assert not bench.set("SYS_ID", 9)[2]


# --- Streams ----------------------------------------------------------------------------------


def test_every_sample_is_told_and_every_second_attitude(bench: Bench) -> None:
    streams = Streams(bench)
    sent = []
    for _ in range(10):
        streams.sample()
        sent.append(streams.due())
    assert sent == [[TILT_SAMPLE, ATTITUDE], [TILT_SAMPLE]] * 5


@pytest.mark.parametrize(
    ("interval_us", "every"), [(1, 1), (14_000, 1), (16_000, 2), (30_000, 3), (1_000_000, 100)]
)
def test_an_interval_is_kept_in_whole_samples(bench: Bench, interval_us: int, every: int) -> None:
    streams = Streams(bench)
    streams.every(ATTITUDE, 0)
    assert streams.every(TILT_SAMPLE, interval_us)
    sent = []
    for _ in range(5 * every):
        streams.sample()
        sent.append(TILT_SAMPLE in streams.due())
    assert [i for i, s in enumerate(sent) if s] == [every * i for i in range(5)]


def test_what_is_off_is_not_sent_but_may_be_asked_for(bench: Bench) -> None:
    streams = Streams(bench)
    streams.every(TILT_SAMPLE, 0)
    streams.every(ATTITUDE, 0)
    for _ in range(5):
        streams.sample()
        assert streams.due() == []
    streams.request(RAW_IMU)
    assert streams.due() == [RAW_IMU]
    assert streams.due() == []


@pytest.mark.parametrize("start_us", [0, 2**32 - 3_500_000])
def test_the_clock_makes_heartbeats_even_where_it_wraps(bench: Bench, start_us: int) -> None:
    streams = Streams(bench, start_us)
    beats = []
    for ms in range(0, 5000, 10):
        streams.time((start_us + 1000 * ms) % 2**32)
        if HEARTBEAT in streams.due():
            beats.append(ms)
    assert beats == [0, 1000, 2000, 3000, 4000]


def test_a_message_that_found_no_room_is_lost_and_counted(bench: Bench) -> None:
    streams = Streams(bench)
    streams.every(ATTITUDE, 0)
    for _ in range(4):
        streams.sample()
    assert streams.state.lost == 3
    assert streams.due() == [TILT_SAMPLE]


def test_the_link_is_not_promised_twice(tmp_path: Path) -> None:
    """Only what fits is accepted, and what does not leaves everything as it was."""
    bench = Bench(tmp_path, limit_bytes_s=10_000)
    streams = Streams(bench)
    assert not streams.every(HIGHRES_IMU, PERIOD_US)
    assert streams.every(HIGHRES_IMU, 5 * PERIOD_US)
    assert not streams.every(RAW_IMU, PERIOD_US)
    streams.sample()
    assert streams.due() == [TILT_SAMPLE, ATTITUDE, HIGHRES_IMU]


# --- Calibration ------------------------------------------------------------------------------

G_COUNT = 16384
RATE_COUNT = 65.5  # per deg/s
REST = (0, 0, G_COUNT)


def noisy(rng: np.random.Generator, mean: tuple[float, ...], sigma: float) -> np.ndarray:
    return np.round(rng.normal(mean, sigma))


def test_a_still_sensor_gives_the_mean_of_a_second(bench: Bench) -> None:
    rng = np.random.default_rng(5)
    gyro = [noisy(rng, (40.0, -25.0, 3.0), 3.0) for _ in range(100)]
    calibration = Calibration(bench)
    events = [calibration.take(noisy(rng, REST, 60.0), g) for g in gyro]
    assert events == [STILL] * 99 + [DONE]
    np.testing.assert_allclose(list(calibration.mean), np.mean(gyro, axis=0), rtol=1e-6)
    assert calibration.take(REST, (0, 0, 0)) == STILL, "it runs no more"


@pytest.mark.parametrize(
    ("accel", "gyro"),
    [
        ((0, 0, G_COUNT), (200, 0, 0)),
        ((0, 0, G_COUNT), (0, 0, -200)),
        ((1000, 0, G_COUNT), (0, 0, 0)),
        ((0, 0, G_COUNT - 1000), (0, 0, 0)),
        ((-32768, 0, 0), (0, 0, 0)),
        ((32767, 0, 0), (0, 32767, 0)),
    ],
    ids=["turn", "turn back", "push", "drop", "negative end", "positive ends"],
)
def test_one_movement_begins_the_window_anew(
    bench: Bench, accel: tuple[int, ...], gyro: tuple[int, ...]
) -> None:
    calibration = Calibration(bench)
    for i in range(150):
        moved = i == 50
        event = calibration.take(accel if moved else REST, gyro if moved else (0, 0, 0))
        assert event == STILL
    assert calibration.take(REST, (0, 0, 0)) == DONE


def test_a_fast_steady_turn_is_not_rest(bench: Bench) -> None:
    calibration = Calibration(bench)
    assert {calibration.take(REST, (0, 0, int(31 * RATE_COUNT))) for _ in range(300)} == {STILL}
    calibration = Calibration(bench)
    events = [calibration.take(REST, (0, 0, int(19 * RATE_COUNT))) for _ in range(100)]
    assert events[-1] == DONE, "19 deg/s may be the zero-rate output of a good part"


def test_it_gives_up_after_ten_windows(bench: Bench) -> None:
    for start_us in (0, 2**32 - 5_000_000):
        calibration = Calibration(bench, start_us)
        assert calibration.poll((start_us + 9_999_999) % 2**32) == STILL
        assert calibration.poll((start_us + 10_000_000) % 2**32) == MOVED
        assert calibration.take(REST, (0, 0, 0)) == STILL


def test_a_gap_drops_the_window(bench: Bench) -> None:
    calibration = Calibration(bench)
    for _ in range(99):
        calibration.take(REST, (0, 0, 0))
    calibration.drop()
    assert calibration.take(REST, (0, 0, 0)) == STILL


def test_movement_is_judged_in_si_units(tmp_path: Path) -> None:
    """The same motion in other counts: the ranges of the design change the weight of a count."""
    coarse = Bench(tmp_path, design(gyro_full_scale_deg_s=2000, accel_full_scale_g=16))
    shake_m_s2, rate_deg_s = 0.4, 1.5
    for limit, expected in ((1.0, DONE), (2.0, STILL)):
        calibration = Calibration(coarse)
        shake = int(limit * shake_m_s2 / STANDARD_GRAVITY_M_S2 * 2048)
        turn = int(limit * rate_deg_s * 16.4)
        events = [
            calibration.take((shake * (i % 2), 0, 2048), (turn * (i % 2), 0, 0)) for i in range(100)
        ]
        assert events[-1] == expected


# --- Receiver ---------------------------------------------------------------------------------

M = python_module()


def packed(message: object, sequence: int = 0) -> bytes:
    mav = M.MAVLink(None, srcSystem=255, srcComponent=190)
    mav.seq = sequence
    return bytes(message.pack(mav))


COMMAND = packed(M.MAVLink_command_long_message(1, 1, 512, 0, 148, 0, 0, 0, 0, 0, 0))
READ = packed(M.MAVLink_param_request_read_message(1, 1, b"SYS_ID", -1))
PING = packed(M.MAVLink_ping_message(2**60, 2**31, 0, 0))
FRAMES = [COMMAND, READ, PING]
IDS = [76, 20, 4]


def test_frames_are_found_one_after_the_other(bench: Bench) -> None:
    receiver = Receiver(bench)
    assert receiver.take(b"".join(FRAMES)) == IDS
    assert (receiver.state.frames, receiver.state.errors) == (3, 0)


def test_frames_that_are_not_listened_to_are_passed_over(bench: Bench) -> None:
    beat = packed(M.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3))
    text = packed(M.MAVLink_statustext_message(6, b"\xfd" * 50))
    receiver = Receiver(bench)
    assert receiver.take(beat + COMMAND + text + READ + beat + PING) == IDS
    assert receiver.state.errors == 0


def test_a_message_of_a_longer_identity_is_none_of_ours(bench: Bench) -> None:
    body = bytearray(COMMAND[1:-2])
    body[8] = 1  # 65612, of which 76 is left in two bytes
    crc = x25crc(bytes(body) + bytes([152])).crc
    assert Receiver(bench).take(COMMAND) == [76]
    receiver = Receiver(bench)
    assert receiver.take(b"\xfd" + bytes(body) + crc.to_bytes(2, "little") + PING) == [4]
    assert receiver.state.errors == 0


def test_flags_that_are_not_understood_pass_the_frame_over(bench: Bench) -> None:
    frame = bytearray(READ)
    frame[2] = 0x02
    receiver = Receiver(bench)
    assert receiver.take(bytes(frame) + PING) == [4]
    assert receiver.state.errors == 0


def test_a_signature_is_skipped(bench: Bench) -> None:
    mav = M.MAVLink(None, srcSystem=255, srcComponent=190)
    mav.signing.secret_key = bytes(range(32))
    mav.signing.sign_outgoing = True
    mav.signing.timestamp = 0xFDFDFDFDFDFD
    signed = bytes(M.MAVLink_ping_message(1, 2, 0, 0).pack(mav))
    assert len(signed) == 13 + len(packed(M.MAVLink_ping_message(1, 2, 0, 0)))
    assert Receiver(bench).take(signed + COMMAND + signed + READ) == [4, 76, 4, 20]


def test_one_wrong_bit_is_one_lost_frame(bench: Bench) -> None:
    """Every bit behind the length; a changed length claims what comes behind, as everywhere."""
    for bit in range(8 * 2, 8 * len(COMMAND)):
        frame = bytearray(COMMAND)
        frame[bit // 8] ^= 1 << (bit % 8)
        found = Receiver(bench).take(bytes(frame) + bytes(20) + READ + PING)
        assert found == [20, 4], f"bit {bit}"


def test_it_finds_frames_again_behind_noise(bench: Bench) -> None:
    rng = random.Random(3)
    for seed in range(300):
        rng.seed(seed)
        noise = bytes(rng.choice((0xFD, rng.randrange(256))) for _ in range(rng.randrange(300)))
        found = Receiver(bench).take(noise + bytes(300) + b"".join(FRAMES))
        assert found[-3:] == IDS


def test_a_frame_that_breaks_off_takes_no_more_than_it_claims(bench: Bench) -> None:
    for length in range(1, len(COMMAND)):
        assert Receiver(bench).take(COMMAND[:length] + bytes(len(COMMAND) - length) + PING)[-1] == 4
