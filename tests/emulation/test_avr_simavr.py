"""A second opinion on the cycles of the filter: the same image on avr8js and on simavr."""

import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from boards import changed, expected_counts, generated, require_or_skip, stimulus
from designs import all_parameters, design

from hostkit.emulation import avr_board
from hostkit.filters import FILTERS
from hostkit.records import FilterDesign

HERE = Path(__file__).parent
EMULATORS = Path(avr_board.__file__).parent
SAMPLES = 200
LIMIT_CYCLES = 40_000_000
CLOCK_HZ = 16_000_000

BENCH = """
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/pgmspace.h>
#include <avr/sleep.h>
#include "hk_filter.h"
#include "hk_hal.h"
static const int16_t counts[SAMPLES][6] PROGMEM = {
ROWS
};
static void put(const uint8_t *bytes, uint8_t count)
{
    for (; count > 0U; count--) {
        while ((UCSR0A & _BV(UDRE0)) == 0U) {
        }
        UDR0 = *bytes++;
    }
}
int main(void)
{
    static hk_filter_t filter;
    uint8_t i;
    UBRR0 = 3U;
    UCSR0B = _BV(TXEN0);
    SETTINGS
    hk_filter_init(&filter);
    for (i = 0U; i < SAMPLES; i++) {
        int16_t sample[6];
        memcpy_P(sample, counts[i], sizeof sample);
        hk_hal_mark_begin();
        (void)hk_filter_update(&filter, sample, sample + 3);
        hk_hal_mark_end();
        put((const uint8_t *)filter.angle, sizeof filter.angle);
    }
    cli();
    sleep_enable();
    sleep_cpu();
    return 0;
}
"""


@pytest.fixture(scope="module")
def simavr(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The harness around simavr; skips where it is not installed."""
    require_or_skip("gcc", "make", "avr-gcc", "node", "avr8js")
    probe = ["gcc", "-E", "-include", "simavr/sim_avr.h", "-x", "c", "/dev/null"]
    if subprocess.run(probe, capture_output=True, timeout=30, check=False).returncode != 0:
        pytest.skip("simavr is not installed; try: sudo apt-get install libsimavr-dev libelf-dev")
    program = tmp_path_factory.mktemp("simavr") / "simavr_cycles"
    source = str(HERE / "simavr_cycles.c")
    command = ["gcc", "-O2", "-Wall", "-o", str(program), source, "-lsimavr", "-lelf"]
    subprocess.run(command, timeout=60, check=True)
    return program


def bench(code: FilterDesign, folder: Path) -> Path:
    """Build an image that filters a stimulus and nothing else."""
    counts = expected_counts(stimulus(SAMPLES, code), code)
    rows = np.hstack([counts.accel, counts.gyro]).tolist()
    text = BENCH.replace("ROWS", ",\n".join(f"    {{{str(row)[1:-1]}}}" for row in rows))
    generated("atmega328p", folder, code)
    defaults = "hk_filter_defaults" in (folder / "hk_filter.h").read_text(encoding="ascii")
    text = text.replace("SETTINGS", "hk_filter_defaults(&filter.settings);" if defaults else "")
    (folder / "main.c").write_text(text.replace("SAMPLES", f"{SAMPLES}U"), encoding="ascii")
    avr_board.build(folder)
    return folder


def heard(command: list[str]) -> tuple[list[int], np.ndarray]:
    """Return the cycles of each update, and roll and pitch after it."""
    done = subprocess.run(command, capture_output=True, text=True, timeout=100, check=False)
    assert done.returncode == 0, done.stderr
    found: dict[str, list[int]] = {"cycles": [], "byte": []}
    for line in done.stdout.splitlines():
        name, _, value = line.partition(" ")
        if name in found:
            found[name].append(int(value))
    return found["cycles"], np.frombuffer(bytes(found["byte"]), dtype="<i4").reshape(-1, 2)


def on_avr8js(folder: Path) -> tuple[list[int], np.ndarray]:
    script, image = str(HERE / "avr8js_cycles.mjs"), str(folder / "firmware.hex")
    return heard(["node", script, str(EMULATORS), image, str(LIMIT_CYCLES / CLOCK_HZ)])


def on_simavr(folder: Path, simavr: Path) -> tuple[list[int], np.ndarray]:
    return heard([str(simavr), str(folder / "firmware.elf"), str(LIMIT_CYCLES)])


@pytest.mark.parametrize("made", [design, all_parameters])
def test_both_count_the_same_cycles_and_find_the_angles_of_the_model(
    simavr: Path, tmp_path: Path, made: Callable[[], FilterDesign]
) -> None:
    code = made()
    folder = bench(code, tmp_path / "code")
    ours, other = on_avr8js(folder), on_simavr(folder, simavr)
    filter_ = FILTERS[code.filter]
    counts = expected_counts(stimulus(SAMPLES, code), code)
    model = filter_.run_integer(filter_.lower(code), counts.accel, counts.gyro)
    np.testing.assert_array_equal(ours[1], model[:, :2])
    np.testing.assert_array_equal(other[1], model[:, :2])
    assert len(ours[0]) == SAMPLES
    assert ours[0] == other[0]
    assert min(ours[0]) > 500


def test_one_instruction_more_is_one_cycle_more_on_both(simavr: Path, tmp_path: Path) -> None:
    folder = bench(design(), tmp_path / "code")
    before = on_avr8js(folder)[0], on_simavr(folder, simavr)[0]
    changed(
        folder / "main.c",
        "        hk_hal_mark_end();",
        '        __asm__ volatile("nop");\n        hk_hal_mark_end();',
    )
    avr_board.build(folder)
    after = on_avr8js(folder)[0], on_simavr(folder, simavr)[0]
    assert after == tuple([cycles + 1 for cycles in run] for run in before)
