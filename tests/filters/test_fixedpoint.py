import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hostkit.errors import FormatError
from hostkit.fixedpoint import coefficient, round_half_up, shift_round, wrap32


@given(st.floats(min_value=1e-9, max_value=65535.4))
def test_coefficient_uses_all_its_bits(real: float) -> None:
    c = coefficient("c", real, "1")
    assert 2**16 <= c.raw < 2**17
    assert abs(c.relative_error) <= 2.0**-17
    assert c.raw == round_half_up(math.ldexp(real, c.format.fraction_bits))


def test_coefficient_that_rounds_up_to_a_power_of_two_moves_its_point() -> None:
    c = coefficient("c", 1.0 - 2.0**-30, "1")
    assert (c.raw, c.format.fraction_bits) == (2**16, 16)


@pytest.mark.parametrize("real", [0.0, -1.0, math.nan, math.inf])
def test_impossible_coefficient_is_refused(real: float) -> None:
    with pytest.raises(FormatError, match="positive"):
        coefficient("rate_gain", real, "1")


@given(st.integers(-(2**48), 2**48), st.integers(1, 40))
def test_shift_round_is_halves_upwards(value: int, bits: int) -> None:
    assert shift_round(value, bits) == (2 * value + 2**bits) // 2 ** (bits + 1)
    assert shift_round(np.array([value]), bits)[0] == shift_round(value, bits)


@given(st.integers(-(2**33), 2**33))
def test_wrap32_is_twos_complement(value: int) -> None:
    wrapped = wrap32(value)
    assert -(2**31) <= wrapped < 2**31
    assert (wrapped - value) % 2**32 == 0
    assert wrap32(np.array([value]))[0] == wrapped
