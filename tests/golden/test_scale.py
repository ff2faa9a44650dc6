"""The multiplications of the C, which avoid 64 bits, against the definition."""

import itertools
from pathlib import Path

import numpy as np
import pytest

from hostkit.fixedpoint import shift_round

FIXED = Path(__file__).resolve().parents[2] / "firmware_templates" / "fixed"
RAWS = (2**16, 2**16 + 1, 3 * 2**15, 2**17 - 2, 2**17 - 1)


@pytest.fixture(scope="module", params=[0, 1], ids=["16-bit", "32-bit"])
def program(
    host_cc, tmp_path_factory: pytest.TempPathFactory, request: pytest.FixtureRequest
) -> Path:
    """Return the harness with the products of small processors, and with those of larger ones."""
    output = tmp_path_factory.mktemp("scale") / "scale"
    harness = Path(__file__).with_name("scale_main.c")
    return host_cc.build(
        output, f"-DHK_LONG_PRODUCT={request.param}", f"-I{FIXED}", harness, FIXED / "hk_fixed.c"
    )


def expected(cases: list[tuple[str, int, int, int]]) -> list[list[str]]:
    return [[str(shift_round(value * raw, frac))] for _, value, raw, frac in cases]


def test_counts_are_scaled_exactly_at_the_extremes_and_between(host_cc, program: Path) -> None:
    rng = np.random.default_rng(1)
    values = [-32768, -32767, -1, 0, 1, 32767, 32768, *rng.integers(-32768, 32769, 40).tolist()]
    raws = [*RAWS, *rng.integers(2**16, 2**17, 10).tolist()]
    cases = [("c", *case) for case in itertools.product(values, raws, range(1, 16))]
    assert host_cc.run(program, cases) == expected(cases)


def test_angles_are_scaled_exactly_at_the_extremes_and_between(host_cc, program: Path) -> None:
    rng = np.random.default_rng(2)
    edges = [s * 2**k + d for k in (0, 15, 16, 17, 30) for s in (1, -1) for d in (-1, 0, 1)]
    values = [-(2**31), -(2**31) + 1, 2**31 - 1, 2**31 - 2, *edges]
    values += rng.integers(-(2**31), 2**31, 60).tolist()
    raws = [*RAWS, *rng.integers(2**16, 2**17, 10).tolist()]
    cases = [("a", *case) for case in itertools.product(values, raws, range(17, 50))]
    assert host_cc.run(program, cases) == expected(cases)


def test_a_bias_is_rounded_exactly_up_to_the_ends_of_its_range(host_cc, program: Path) -> None:
    rng = np.random.default_rng(4)
    cases = []
    for bits in range(1, 31):
        largest = 2**31 - 1 - 2 ** (bits - 1)
        values = [-(2**31), -largest, -1, 0, 1, largest, *rng.integers(-largest, largest, 20)]
        cases += [("s", int(value), 0, bits) for value in values]
    wanted = [[str(shift_round(value, bits))] for _, value, _, bits in cases]
    assert host_cc.run(program, cases) == wanted


def test_weight_of_nearly_one_is_scaled_exactly(host_cc, program: Path) -> None:
    """With frac 16 only raw = 2^16 keeps the product of every angle within 32 bits."""
    rng = np.random.default_rng(3)
    values = [-(2**31), 2**31 - 1, -1, 0, 1, *rng.integers(-(2**31), 2**31, 60).tolist()]
    cases = [("a", value, 2**16, 16) for value in values]
    assert host_cc.run(program, cases) == expected(cases)


def test_products_of_words_are_rounded_down(host_cc, program: Path) -> None:
    rng = np.random.default_rng(5)
    edges = [s * 2**k + d for k in (0, 8, 15, 16, 24, 30) for s in (1, -1) for d in (-1, 0, 1)]
    words = [-(2**31), -(2**31) + 1, 2**31 - 1, *edges, *rng.integers(-(2**31), 2**31, 30).tolist()]
    cases = [("p", a, b, 0) for a, b in itertools.product(words, words)]
    wanted = [[str(a * b >> 32)] for _, a, b, _ in cases]
    assert host_cc.run(program, cases) == wanted


def test_a_gain_times_a_count_is_rounded_down(host_cc, program: Path) -> None:
    rng = np.random.default_rng(6)
    counts = [-32768, -32767, -1, 0, 1, 32767, *rng.integers(-32768, 32768, 30).tolist()]
    gains = [0, 1, 2**15, 2**16 - 1, 2**31 - 1, *rng.integers(0, 2**31, 30).tolist()]
    cases = [("g", count, gain, 0) for count, gain in itertools.product(counts, gains)]
    wanted = [[str(count * gain >> 15)] for _, count, gain, _ in cases]
    assert host_cc.run(program, cases) == wanted
