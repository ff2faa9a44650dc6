"""Generated code with another filter in it: one whose state is long, and which has three biases."""

import shutil
from pathlib import Path

import numpy as np
from boards import Heard, changed
from designs import design

from hostkit.render import FirmwareOptions, generate, write
from hostkit.render.link_plan import link_plan
from hostkit.targets import TARGETS

SOURCES = Path(__file__).parent / "firmware" / "long_filter"
WORDS = 17
PARAMETERS = (
    *("SYS_ID", "CAL_START", "FILT_KT", "FILT_KV", "FILT_KB"),
    *("GYRO_BIAS_X", "GYRO_BIAS_Y", "GYRO_BIAS_Z"),
)


def with_long_filter(target: str, folder: Path, options: FirmwareOptions | None = None) -> Path:
    """Generate the code of a design and put the other filter in the place of its own."""
    options = options or FirmwareOptions()
    write(generate(design(), TARGETS[target], options), folder)
    (folder / "hk_filter_settings.c").unlink()
    for source in SOURCES.iterdir():
        shutil.copy(source, folder)
    plan = link_plan(design().rate_hz, TARGETS[target], options, hidden_words=WORDS)
    (row,) = [m for m in plan.messages if m.name == "TILT_STATE"]
    text = f"X({row.name}, UINT32_C({row.interval_us}), {row.frame_bytes}U) \\\n    "
    header = folder / "hk_design.h"
    changed(header, "X(ATTITUDE,", f"{text}X(ATTITUDE,")
    changed(header, "#define HK_TOLD_WORDS 0", f"#define HK_TOLD_WORDS {plan.state_words}")
    return folder


SLOW_LINK = """
static uint64_t empty_ns;

bool hk_hal_transmit(const uint8_t *bytes, uint8_t count)
{
    if (empty_ns < board.now_ns) {
        empty_ns = board.now_ns;
    }
    empty_ns += BYTE_NS * (uint64_t)(count == 2U ? 15U : count); /* a checksum, and its signature */
    hk_host_link_put(bytes, count);
    return true;
}

uint8_t hk_hal_transmit_room(void)
{
    const uint64_t queued = empty_ns > board.now_ns ? (empty_ns - board.now_ns) / BYTE_NS : 0U;

    return queued > UINT8_MAX ? 0U : (uint8_t)(UINT8_MAX - queued);
}

bool hk_hal_receive("""


def with_slow_link(folder: Path, bytes_per_s: int) -> Path:
    """Give the host a queue of 255 bytes, which takes frames as if they were signed."""
    hal = folder / "hk_hal_host.c"
    text = hal.read_text(encoding="ascii")
    before, rest = text.split("bool hk_hal_transmit(")
    _, after = rest.split("bool hk_hal_receive(")
    slow = SLOW_LINK.replace("BYTE_NS", f"UINT64_C({1_000_000_000 // bytes_per_s})").lstrip()
    hal.write_text(before + slow + after, encoding="ascii")
    return folder


def signed_word(number: int) -> int:
    return (number + 2**31) % 2**32 - 2**31


def words_after(heard: Heard, first: int, last: int) -> list[int]:
    """Return what the filter tells after a sample, but for its biases, if it began with another."""
    told = {s.sequence: [*s.accel, *s.gyro] for s in heard.samples}
    counts = np.array([told[k] for k in range(first, last + 1)])
    sums = [signed_word(int(total)) for total in counts.sum(axis=0)]
    return [len(counts), *sums, *counts[-1].tolist()]


def states(heard: Heard) -> list[tuple[int, list[int]]]:
    """Return sequence and words of each state that was told; those that are not used must be 0."""
    found = [(m.sequence, list(m.words)) for m in heard.of("TILT_STATE")]
    assert all(words[WORDS:] == [0] * (24 - WORDS) for _, words in found)
    return [(sequence, words[:WORDS]) for sequence, words in found]
