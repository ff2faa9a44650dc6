"""The arc tangent and the arc sine of the C, alone, against the Python that defines them."""

import itertools
from pathlib import Path

import numpy as np
import pytest
from boards import changed
from designs import design

from hostkit.filters.arctan import arcsin_count, arctan_table, atan2_count, atan2_length
from hostkit.render import render_target, write
from hostkit.targets import TARGETS

EDGES = (-32768, -32767, -16384, -1, 0, 1, 63, 64, 16384, 32767, 32768)
ONES = (2048, 4096, 8192, 16384)


def cases() -> np.ndarray:
    """Rows of y, x, z, one: corners, next to every turn, any direction at any length."""
    rng = np.random.default_rng(11)
    corners = np.array([(*c, 16384) for c in itertools.product(EDGES, repeat=3)])
    y = np.array([turn * 500 + near for turn in range(65) for near in (-1, 0, 1)])
    turns = np.stack([y, np.full_like(y, 32000), y - 16000, np.full_like(y, 2048)], axis=1)
    size = 2.0 ** rng.uniform(0, 15, (4000, 1))
    anywhere = np.rint(size * rng.uniform(-1.0, 1.0, (4000, 3)))
    ones = rng.choice(ONES, (4000, 1))
    return np.vstack([corners, turns, turns[:, [1, 0, 2, 3]], np.hstack([anywhere, ones])]).astype(
        np.int64
    )


CASES = cases()


def expected() -> np.ndarray:
    table = arctan_table()
    y, x, z, one = CASES.T
    angle, length, stretch = atan2_count(table, y, x)
    sines = np.array([arcsin_count(table, z[[i]], int(one[i]))[0] for i in range(len(z))])
    turn = np.searchsorted(table.stretches_raw, stretch)
    pitch = atan2_length(table, z, length, stretch)
    return np.stack([angle, angle, length, turn, pitch, sines], axis=1)


def answers(host_cc, folder: Path, divides: int) -> np.ndarray:
    harness = Path(__file__).with_name("arctan_main.c")
    source = folder / "hk_arctan.c"
    way = f"-DHK_DIVIDES={divides}"
    program = host_cc.build(folder / "arctan", way, f"-I{folder}", harness, source)
    return np.array(host_cc.run(program, CASES.tolist()), dtype=np.int64)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write(render_target(design(), TARGETS["host"]), tmp_path)
    return tmp_path


@pytest.mark.parametrize("divides", [0, 1])
def test_the_c_equals_python(host_cc, folder: Path, divides: int) -> None:
    wanted = expected()
    assert set(wanted[:, 3].tolist()) == set(range(64))
    np.testing.assert_array_equal(answers(host_cc, folder, divides), wanted)


@pytest.mark.parametrize(
    ("divides", "old", "new"),
    [
        (1, " 531488619", " 531488618"),
        (1, " 105699", " 105700"),
        (0, "HK_SLOPE_RAW    UINT16_C(41719)", "HK_SLOPE_RAW    UINT16_C(41718)"),
        (0, "fine + 1U", "fine + 0U"),
        (0, "    if (y > x)", "    if (y >= x)"),
        (0, "        if (rest >= x)", "        if (rest > x)"),
        (1, "rest >= x && *y != x", "rest > x && *y != x"),
        (1, "quotient++", "quotient += 0U"),
        (0, "y >> 8", "(y + 128U) >> 8"),
        (1, "uint8_t)(bits >> 24) >> 6", "uint8_t)(bits >> 24) >> 7"),
    ],
)
def test_a_fault_is_found(host_cc, folder: Path, divides: int, old: str, new: str) -> None:
    changed(folder / "hk_arctan.c", old, new)
    assert (answers(host_cc, folder, divides) != expected()).any()
