from itertools import pairwise
from pathlib import Path

import pytest
from boards import (
    ACTIVE,
    BOOT,
    CRITICAL,
    RESTARTED,
    assert_every_row_once,
    changed,
    copied,
    expected_counts,
    generated,
    hear,
    stimulus,
    with_faults,
)
from designs import design

from hostkit.emulation import host_board


def test_starts_within_a_third_of_a_second(host_folder: Path) -> None:
    first = hear(host_board.run(host_folder, stimulus(5))).samples[0]
    assert 0.2e6 < first.time_usec < 0.33e6


def test_settle_samples_are_dropped(host_folder: Path, tmp_path: Path) -> None:
    """A driver that drops one sample less shows row 0 twice."""
    folder = copied(host_folder, tmp_path / "code")
    changed(folder / "hk_design.h", "HK_SETTLE_SAMPLES 3U", "HK_SETTLE_SAMPLES 2U")
    host_board.build(folder)
    samples = hear(host_board.run(folder, stimulus(10))).samples
    assert len(samples) == 11
    assert samples[0].accel == samples[1].accel


@pytest.mark.parametrize("nack", [1, 3, 4])
@pytest.mark.parametrize("from_row", [0, 50])
def test_single_nacks_cost_no_sample(host_folder: Path, nack: int, from_row: int) -> None:
    feels = with_faults(stimulus(100), nack=nack, from_row=from_row)
    heard = hear(host_board.run(host_folder, feels))
    assert_every_row_once(heard, feels)
    assert heard.samples[-1].i2c_errors == nack


@pytest.mark.parametrize("clocks", [1, 6, 9])
@pytest.mark.parametrize("from_row", [0, 50])
def test_a_stuck_data_line_is_freed(host_folder: Path, clocks: int, from_row: int) -> None:
    feels = with_faults(stimulus(100), hold_sda_clocks=clocks, from_row=from_row)
    heard = hear(host_board.run(host_folder, feels))
    assert_every_row_once(heard, feels)
    assert 1 <= heard.samples[-1].i2c_errors <= 2


def test_many_failures_restart_sensor_and_filter(host_folder: Path) -> None:
    feels = with_faults(stimulus(200), nack=13, from_row=50)
    heard = hear(host_board.run(host_folder, feels))
    samples = heard.samples
    restarts = [s.sequence for s in samples if s.flags & RESTARTED]
    assert len(restarts) == 2
    assert restarts[0] == 0
    assert restarts[1] > 45
    assert [s.sequence for s in samples] == list(range(len(samples)))
    counts = expected_counts(feels)
    tail = len(samples) - restarts[1]
    assert [s.gyro for s in samples[-tail:]] == counts.gyro[-tail:].tolist()


def test_a_dead_bus_is_critical_and_says_so(host_folder: Path) -> None:
    heard = hear(host_board.run(host_folder, with_faults(stimulus(10), nack=10**6)))
    assert heard.samples == []
    assert heard.states[0] == BOOT
    assert set(heard.states[1:]) == {CRITICAL}
    assert {t.text for t in heard.of("STATUSTEXT")} == {"MPU-6050 does not answer: I2C bus fault"}


@pytest.mark.parametrize("identity", [0x00, 0xFF])
def test_all_zeros_and_all_ones_are_a_bus_fault(host_folder: Path, identity: int) -> None:
    heard = hear(host_board.run(host_folder, with_faults(stimulus(10), who_am_i=identity)))
    assert {t.text for t in heard.of("STATUSTEXT")} == {"MPU-6050 does not answer: I2C bus fault"}


def test_a_refused_sensor_is_tried_again(host_folder: Path) -> None:
    """Six dead addressings: five tries are refused, a second later the sensor is there."""
    feels = with_faults(stimulus(20), nack=6)
    heard = hear(host_board.run(host_folder, feels))
    assert_every_row_once(heard, feels)
    assert heard.states[:2] == [BOOT, CRITICAL]
    assert heard.states[-1] == ACTIVE
    assert heard.samples[0].time_usec > 1.2e6


def test_a_register_that_does_not_take_its_value_restarts(
    host_folder: Path, tmp_path: Path
) -> None:
    folder = copied(host_folder, tmp_path / "code")
    model = folder / "hk_virtual_registers.c"
    changed(model, "    case HK_REG_FIFO_EN:\n        sensor->reg", "        sensor->reg")
    changed(folder / "hk_design.h", "X(0x23, 0x00)", "X(0x23, 0x08)")
    host_board.build(folder)
    run = host_board.run(folder, stimulus(10))
    heard = hear(run)
    assert heard.samples == []
    assert set(heard.states) == {BOOT}
    assert dict(run.faults)["stalled"] == 1


@pytest.mark.parametrize(("identity", "starts"), [(0x68, True), (0x70, False), (0x72, True)])
def test_a_sister_part_must_keep_its_accelerometer_filter(
    host_folder: Path, tmp_path: Path, identity: int, starts: bool
) -> None:
    folder = copied(host_folder, tmp_path / "code")
    model = folder / "hk_virtual_registers.c"
    changed(model, "if (own_accel_filter(sensor->faults.who_am_i)) {", "if (address == 0U) {")
    changed(
        model,
        "static bool own_accel_filter",
        "bool own_accel_filter(uint8_t);\nbool own_accel_filter",
    )
    host_board.build(folder)
    heard = hear(host_board.run(folder, with_faults(stimulus(10), who_am_i=identity)))
    assert (len(heard.samples) == 10) is starts
    texts = {t.text for t in heard.of("STATUSTEXT")}
    assert ("MPU-6050: restart, register 0x1D was 0x00 #1" in texts) is not starts


def test_a_sensor_that_falls_silent_is_reset(host_folder: Path, tmp_path: Path) -> None:
    """The model stops once, with every register as it was set."""
    folder = copied(host_folder, tmp_path / "code")
    changed(
        folder / "hk_virtual_sampling.c",
        "    measure(sensor, row);\n",
        "    if (sensor->replay.rows_played == 20U) {\n"
        "        sensor->sample_ns = HK_NEVER;\n        sensor->replay.rows_played++;\n"
        "        return;\n    }\n    measure(sensor, row);\n",
    )
    host_board.build(folder)
    heard = hear(host_board.run(folder, stimulus(60)))
    restarts = [s.sequence for s in heard.samples if s.flags & RESTARTED]
    assert restarts == [0, 19]
    assert len(heard.samples) == 59
    assert heard.samples[-1].i2c_errors == 1
    assert [t.text for t in heard.of("STATUSTEXT")] == ["MPU-6050: silent, restart #1"]
    assert heard.states.count(CRITICAL) >= 1
    assert heard.states[-1] == ACTIVE


@pytest.mark.parametrize(
    ("rate_hz", "low_pass"), [(500.0, 1), (250.0, 2), (50.0, 6), (4.0, 5), (200.0, 0)]
)
def test_other_rates(tmp_path: Path, rate_hz: float, low_pass: int) -> None:
    code = design(rate_hz=rate_hz, low_pass_setting=low_pass, gyro_full_scale_deg_s=250)
    folder = generated("host", tmp_path / "code", code)
    host_board.build(folder, sanitize=True)
    feels = stimulus(40, code)
    heard = hear(host_board.run(folder, feels))
    assert_every_row_once(heard, feels, code)
    times = [s.time_usec for s in heard.samples]
    assert {b - a for a, b in pairwise(times)} == {round(1e6 / rate_hz)}
