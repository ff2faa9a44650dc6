import os
from pathlib import Path

import numpy as np
import pytest
from boards import (
    BOOT,
    CRITICAL,
    Collector,
    assert_every_row_once,
    changed,
    copied,
    hear,
    stimulus,
    with_faults,
)

from hostkit.emulation import avr_board, host_board, tools
from hostkit.errors import EmulationError, ToolMissingError

FLASH_LIMIT, RAM_LIMIT = 26 * 1024, 1228
LATENCY_US = 8


def test_image_is_small(avr_folder: Path) -> None:
    built = avr_board.build(avr_folder)
    assert built.artifact.is_file()
    assert built.flash_bytes is not None
    assert built.ram_bytes is not None
    assert 4000 < built.flash_bytes < FLASH_LIMIT
    assert 300 < built.ram_bytes <= RAM_LIMIT


def test_every_row_arrives_once_with_the_counts_of_the_model(avr_folder: Path) -> None:
    feels = stimulus()
    progress: list[int] = []
    run = avr_board.run(avr_folder, feels, progress=progress.append)
    assert_every_row_once(hear(run), feels)
    assert run.faults == ()
    assert progress[-1] == len(feels)
    assert run.cycles_mean is not None
    assert run.cycles_max is not None
    assert 1000 < run.cycles_mean <= run.cycles_max < 16000
    assert run.stack_bytes is not None
    assert 100 < run.stack_bytes < 1024


def test_samples_are_timed_by_the_interrupt(avr_folder: Path) -> None:
    samples = hear(avr_board.run(avr_folder, stimulus(1000))).samples
    times = np.array([s.time_usec for s in samples])
    late_us = times - times[0] - 10_000 * np.arange(len(times))
    assert np.all(np.abs(late_us) <= LATENCY_US), "another interrupt is being served"
    assert np.mean(np.abs(late_us) <= 1) > 0.95


def test_the_same_angles_as_on_the_host(avr_folder: Path, host_folder: Path) -> None:
    feels = stimulus(300)
    answers = [
        [(s.sequence, s.roll, s.pitch, s.flags, s.digest) for s in hear(run).samples]
        for run in (avr_board.run(avr_folder, feels), host_board.run(host_folder, feels))
    ]
    assert answers[0] == answers[1]


def test_wrong_identity_is_refused(avr_folder: Path) -> None:
    run = avr_board.run(avr_folder, with_faults(stimulus(), who_am_i=0x12))
    heard = hear(run)
    assert heard.samples == []
    assert heard.states[0] == BOOT
    assert set(heard.states[1:]) == {CRITICAL}
    assert {t.text for t in heard.of("STATUSTEXT")} == {"MPU-6050 refused: WHO_AM_I is 0x12"}
    assert dict(run.faults)["stalled"] == 1


@pytest.mark.parametrize("from_row", [0, 100])
def test_nacks_are_survived(avr_folder: Path, from_row: int) -> None:
    feels = with_faults(stimulus(), nack=3, from_row=from_row)
    heard = hear(avr_board.run(avr_folder, feels))
    assert_every_row_once(heard, feels)
    assert heard.samples[-1].i2c_errors == 3
    assert [s.i2c_errors for s in heard.samples if s.sequence < from_row - 20] == [0] * (
        max(from_row - 20, 0)
    )


@pytest.mark.parametrize(
    ("clocks", "from_row", "errors"), [(6, 0, 0), (9, 0, 0), (9, 100, 1), (20, 0, 2)]
)
def test_a_stuck_data_line_is_freed(
    avr_folder: Path, clocks: int, from_row: int, errors: int
) -> None:
    feels = with_faults(stimulus(), hold_sda_clocks=clocks, from_row=from_row)
    heard = hear(avr_board.run(avr_folder, feels))
    assert_every_row_once(heard, feels)
    assert heard.samples[-1].i2c_errors <= errors


def test_a_stuck_interrupt_pin_gives_no_sample_twice(avr_folder: Path, tmp_path: Path) -> None:
    folder = copied(avr_folder, tmp_path / "code")
    changed(
        folder / "hk_virtual_mpu6050.c",
        "return sensor->latch != active_low;",
        "(void)active_low;\n    return true;",
    )
    avr_board.build(folder)
    feels = stimulus(200)
    heard = hear(avr_board.run(folder, feels))
    assert_every_row_once(heard, feels)
    texts = [t.text for t in heard.of("STATUSTEXT")]
    assert texts[0] == "MPU-6050: INT lost, polling #1"
    assert set(texts[1:]) <= {"MPU-6050: silent, restart #1"}, "after the end of the table"


def test_a_wrong_range_is_seen_in_the_counts(avr_folder: Path, tmp_path: Path) -> None:
    folder = copied(avr_folder, tmp_path / "code")
    changed(folder / "hk_design.h", "X(0x1B, 0x08)", "X(0x1B, 0x10)")
    avr_board.build(folder)
    feels = stimulus(30)
    with pytest.raises(AssertionError, match="Mismatched elements"):
        assert_every_row_once(hear(avr_board.run(folder, feels)), feels)


def test_serve_streams_in_real_time(avr_folder: Path) -> None:
    collector = Collector(lambda data: len(hear(data).samples) > 50)
    avr_board.serve(avr_folder, stimulus(20), collector.send, collector.stop)
    samples = hear(collector.data).samples
    assert [s.sequence for s in samples] == list(range(len(samples)))
    assert samples[0].accel == samples[20].accel


SLEEPER = """
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>
#include "hk_hal.h"
int main(void)
{
    hk_hal_init();
    for (;;) {
        cli();
        while ((TIFR1 & _BV(TOV1)) == 0U) {
        }
        hk_hal_mark_begin();
        sleep_enable();
        ENABLE;
        sleep_cpu();
        hk_hal_mark_end();
    }
}
"""


@pytest.mark.parametrize("enable", ["sei()", "SREG |= _BV(SREG_I)"])
def test_one_instruction_runs_before_an_interrupt_that_waits(
    avr_folder: Path, tmp_path: Path, enable: str
) -> None:
    """Else the interrupt would come before the sleep and not end it."""
    folder = copied(avr_folder, tmp_path / "code")
    (folder / "main.c").write_text(SLEEPER.replace("ENABLE", enable), encoding="ascii")
    avr_board.build(folder)
    run = avr_board.run(folder, stimulus(3))
    assert run.cycles_max is not None
    assert run.cycles_max < 100


def test_firmware_that_jumps_to_its_start_is_noticed(avr_folder: Path, tmp_path: Path) -> None:
    folder = copied(avr_folder, tmp_path / "code")
    changed(folder / "main.c", "    hk_app_init(&app);", '    __asm__ volatile("jmp 0");')
    avr_board.build(folder)
    with pytest.raises(EmulationError, match=r"jumped to its start after 0\.0"):
        avr_board.run(folder, stimulus(3))


def test_firmware_that_stops_is_noticed(avr_folder: Path, tmp_path: Path) -> None:
    folder = copied(avr_folder, tmp_path / "code")
    changed(folder / "hk_hal_atmega328p.c", "sei();\n    sleep_cpu();", "cli();\n    sleep_cpu();")
    changed(folder / "hk_hal_atmega328p.c", "    hk_watchdog_start();\n", "")
    avr_board.build(folder)
    with pytest.raises(EmulationError, match=r"board\.mjs .*sleeps for ever"):
        avr_board.run(folder, stimulus(3))


def test_a_damaged_image_is_noticed(avr_folder: Path, tmp_path: Path) -> None:
    folder = copied(avr_folder, tmp_path / "code")
    avr_board.build(folder)
    image = folder / "firmware.hex"
    image.write_text(image.read_text(encoding="ascii").replace("0C94", "0C95", 1), encoding="ascii")
    with pytest.raises(EmulationError, match=r"board\.mjs failed .*damaged"):
        avr_board.run(folder, stimulus(3))


def test_missing_tools_are_named_with_their_remedy(
    avr_folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tools, "NODE_FOLDERS", tmp_path)
    with pytest.raises(ToolMissingError, match=r"avr8js is not installed; .*make setup"):
        avr_board.run(avr_folder, stimulus(3))
    monkeypatch.setenv("PATH", str(tmp_path))
    assert os.environ["PATH"] == str(tmp_path)
    with pytest.raises(ToolMissingError, match=r"make is not installed; .*apt-get install make"):
        avr_board.build(avr_folder)
