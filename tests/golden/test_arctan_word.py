"""The arc tangent of words: how exact it is, and the C against the Python that defines it."""

from pathlib import Path

import numpy as np
import pytest
from boards import changed
from designs import design

from hostkit.filters.arctan import LEAST_WORD, arctan_table, atan2_word, atan2_word_length
from hostkit.render import render_target, write
from hostkit.targets import TARGETS
from hostkit.units import RAD_PER_HALF_TURN_LSB

ONE = 2**27
EDGES = (0, 1, LEAST_WORD - 1, LEAST_WORD, LEAST_WORD + 1, 2**14, 2**20, ONE, 2**29)


def directions(samples: int = 3000) -> np.ndarray:
    """Up vectors with 27 fraction bits, many of them next to an axis, shape ``(N, 3)``."""
    rng = np.random.default_rng(4)
    up = rng.normal(size=(samples, 3)) * 10.0 ** rng.uniform(-5, 0, (samples, 3))
    return np.rint(ONE * up / np.linalg.norm(up, axis=1, keepdims=True)).astype(np.int64)


def cases() -> np.ndarray:
    corners = [(y, x, z) for y in EDGES for x in EDGES for z in (0, ONE)]
    signs = np.array([(1, 1, 1), (-1, 1, -1), (1, -1, 1), (-1, -1, -1)])
    return np.vstack([np.array(corners) * sign for sign in signs] + [directions()])


def angles(rows: np.ndarray) -> tuple[np.ndarray, ...]:
    table = arctan_table()
    y, x, z = rows.T
    angle, length, stretch = atan2_word(table, y, x)
    return angle, length, stretch, atan2_word_length(table, z, length, stretch)


def test_inclination_is_exact_to_a_thousandth_of_a_degree() -> None:
    rows = directions()
    roll, _, _, pitch = (part * RAD_PER_HALF_TURN_LSB for part in angles(rows))
    up = np.stack([np.sin(roll) * np.cos(pitch), np.cos(roll) * np.cos(pitch), np.sin(pitch)], 1)
    exact = rows / np.linalg.norm(rows, axis=1, keepdims=True)
    apart = np.degrees(np.linalg.norm(np.cross(up, exact), axis=1))
    nothing = np.abs(rows[:, :2]).max(axis=1) < LEAST_WORD
    assert apart[~nothing].max() < 2e-4
    assert apart.max() < 5e-3


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write(render_target(design(), TARGETS["host"]), tmp_path)
    return tmp_path


def answers(host_cc, folder: Path, divides: int) -> np.ndarray:
    harness = Path(__file__).with_name("arctan_word_main.c")
    source = folder / "hk_arctan.c"
    way = f"-DHK_DIVIDES={divides}"
    program = host_cc.build(folder / "arctan", way, f"-I{folder}", harness, source)
    return np.array(host_cc.run(program, cases().tolist()), dtype=np.int64)


def expected() -> np.ndarray:
    angle, length, stretch, second = angles(cases())
    turn = np.searchsorted(arctan_table().stretches_raw, stretch)
    return np.stack([angle, length, turn, second], axis=1)


@pytest.mark.parametrize("divides", [0, 1])
def test_the_c_equals_python(host_cc, folder: Path, divides: int) -> None:
    got, wanted = answers(host_cc, folder, divides), expected()
    some = (wanted[:, 1] != 0) | (np.abs(cases()[:, 2]) >= LEAST_WORD)
    np.testing.assert_array_equal(got[some], wanted[some])


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("HK_LEAST_WORD_BITS 13", "HK_LEAST_WORD_BITS 12"),
        ("32 - HK_STRETCH_FRAC)", "31 - HK_STRETCH_FRAC)"),
        ("hk_with_sign_of(y, x < 0 ?", "hk_with_sign_of(y, x <= 0 ?"),
    ],
)
def test_a_fault_is_found(host_cc, folder: Path, old: str, new: str) -> None:
    changed(folder / "hk_arctan.c", old, new)
    assert (answers(host_cc, folder, 0) != expected()).any()
