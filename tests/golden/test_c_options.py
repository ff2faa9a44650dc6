"""The C filter, with sanitizers, for every parameter alone, together and at its limits."""

from pathlib import Path

import numpy as np
import pytest
from boards import changed
from c_filter import c_response
from hdl_cases import design_name, option_designs, option_vectors

from hostkit.filters.complementary import lower, run_integer
from hostkit.records import AXES, FilterDesign
from hostkit.render import render_target, write
from hostkit.targets import TARGETS


def expected(option: FilterDesign, accel: np.ndarray, gyro: np.ndarray) -> np.ndarray:
    axes = AXES[option.axes]
    state = run_integer(lower(option), accel, gyro)
    out = np.zeros((len(accel), 5), dtype=np.int64)
    out[:, [("roll", "pitch").index(axis) for axis in axes]] = state[:, : len(axes)]
    out[0, 2] = 1
    out[:, 3 : 3 + state.shape[1] - len(axes)] = state[:, len(axes) :]
    return out


@pytest.mark.parametrize("option", option_designs(), ids=design_name)
def test_the_c_equals_the_integer_model(host_cc, option: FilterDesign, tmp_path: Path) -> None:
    write(render_target(option, TARGETS["host"]), tmp_path)
    accel, gyro = option_vectors(option)
    got = c_response(host_cc, tmp_path, np.hstack([accel, gyro]), tmp_path / "vectors")
    np.testing.assert_array_equal(got, expected(option, accel, gyro))


@pytest.mark.parametrize(
    ("file", "old", "new"),
    [
        ("hk_filter.c", "square <= HK_GATE_HIGHEST", "square < HK_GATE_HIGHEST"),
        ("hk_filter.c", "hk_wrap_sub(tilt, predicted) : 0", "hk_wrap_sub(tilt, predicted) : tilt"),
        ("hk_filter.c", "*bias - change", "*bias + change"),
        ("hk_fixed.h", "value < -limit ? -limit : value", "value < -limit ? value : value"),
        (
            "hk_filter.c",
            "filter->bias[HK_PITCH] = filter->settings.bias[HK_PITCH]",
            "filter->bias[HK_PITCH] = 0",
        ),
    ],
)
def test_a_fault_is_found(host_cc, tmp_path: Path, file: str, old: str, new: str) -> None:
    option = option_designs()[0]
    write(render_target(option, TARGETS["host"]), tmp_path)
    changed(tmp_path / file, old, new)
    accel, gyro = option_vectors(option)
    got = c_response(host_cc, tmp_path, np.hstack([accel, gyro]), tmp_path / "vectors")
    assert (got != expected(option, accel, gyro)).any()
