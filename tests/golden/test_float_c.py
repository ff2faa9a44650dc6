"""The filter in floats against the float model: wild motion, and turns through half a turn."""

from pathlib import Path

import numpy as np
import pytest
from boards import changed
from designs import all_parameters, design, more_parameters
from hdl_cases import design_name, option_designs
from samples import stimulus as extremes

from hostkit.filters.complementary import lower, run_float
from hostkit.records import AXES, FilterDesign
from hostkit.render import render_target, write
from hostkit.render.options import FirmwareOptions
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import Counts, to_rate_and_force_g
from hostkit.targets import TARGETS
from hostkit.units import RAD_PER_HALF_TURN_LSB

TOLERANCE_DEG = 1.5e-3
"""Measured: up to 0.0011 deg where a gate stays shut for 30 s, up to 0.0006 deg elsewhere."""

SECOND = 100
DESIGNS = (*option_designs(), design(), design(mounting="+z+x+y"), design(axes="roll"))


def turning(samples: int = 3000) -> np.ndarray:
    """Counts of a body that rolls through +-180 deg 14 times, faster and slower, both ways."""
    t = np.arange(samples) / SECOND
    roll = 40.0 * np.sin(0.25 * t)
    rate = 10.0 * np.cos(0.25 * t)
    counts = np.zeros((samples, 6))
    counts[:, 1], counts[:, 2] = 15000 * np.sin(roll), 15000 * np.cos(roll)
    counts[:, 3] = np.degrees(rate) * 65.5
    counts += np.random.default_rng(3).normal(0.0, 40.0, counts.shape)
    return np.clip(np.round(counts), -32768, 32767).astype(np.int64)


def wild(samples: int = 3000) -> np.ndarray:
    """Counts of any size; the force stays far enough from zero for a direction."""
    rng = np.random.default_rng(4)
    counts = rng.normal(0.0, 9000.0, (samples, 6))
    return np.clip(np.round(counts), -32768, 32767).astype(np.int64)


def response(host_cc, code: FilterDesign, folder: Path, counts: np.ndarray, *fault: str):
    """Return angles in rad, in half turns, and the hidden words of the C."""
    options = FirmwareOptions(arithmetic="float")
    write(render_target(code, TARGETS["host"], options), folder)
    if fault:
        changed(folder / fault[0], *fault[1:])
    harness = Path(__file__).with_name("float_main.c")
    program = host_cc.build(
        folder / "float", "-ffp-contract=off", f"-I{folder}", harness, folder / "hk_filter.c", "-lm"
    )
    rows = np.array(host_cc.run(program, counts.tolist()), dtype=np.int64)
    assert rows[:, 4].tolist() == [1] + [0] * (len(counts) - 1)
    return rows[:, :2].astype(np.uint32).view(np.float32), rows[:, 2:4], rows[:, 5:]


def modelled(code: FilterDesign, counts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the angles of roll and pitch and the biases of the float model, 0 without an axis."""
    both = Counts(accel=counts[:, :3], gyro=counts[:, 3:])
    states = run_float(code, *to_rate_and_force_g(SENSORS["mpu6050"], code.sensor, both))
    axes = AXES[code.axes]
    angles = np.zeros((len(counts), 2))
    for i, axis in enumerate(axes):
        angles[:, ("roll", "pitch").index(axis)] = states[:, i]
    return angles, states[:, len(axes) :]


def apart_deg(found: np.ndarray, wanted: np.ndarray) -> float:
    return float(np.degrees(np.abs((found - wanted + np.pi) % (2 * np.pi) - np.pi).max()))


@pytest.mark.parametrize("counts", [wild(), turning(), extremes()], ids=["wild", "turn", "ends"])
@pytest.mark.parametrize("code", DESIGNS, ids=design_name)
def test_it_follows_the_float_model(
    host_cc, code: FilterDesign, counts: np.ndarray, tmp_path: Path
) -> None:
    rad, units, hidden = response(host_cc, code, tmp_path, counts)
    angles, biases = modelled(code, counts)
    assert apart_deg(rad.astype(np.float64), angles) < TOLERANCE_DEG
    assert np.abs(rad).max() <= np.float32(np.pi)
    assert apart_deg(units * RAD_PER_HALF_TURN_LSB, rad.astype(np.float64)) < 2e-5
    per_unit = [word.per_unit for word in lower(code).hidden]
    found = hidden[:, : len(per_unit)] * per_unit
    np.testing.assert_allclose(found, biases, atol=1e-5)


def test_the_turn_goes_through_half_a_turn() -> None:
    angles, _ = modelled(design(), turning())
    assert (np.abs(np.diff(angles[:, 0])) > np.pi).sum() >= 14


@pytest.mark.parametrize(
    ("code", "fault"),
    [
        (design(), ("hk_filter.c", "hk_wrapped(tilt - predicted)", "(tilt - predicted)")),
        (design(), ("hk_filter.c", "+ blend * innovation", "+ 1.02f * blend * innovation")),
        (design(), ("hk_filter.c", "hk_wrapped(angle + turn)", "(angle + turn * 1.001f)")),
        (
            all_parameters(),
            ("hk_filter.c", "*bias -= HK_BIAS_GAIN", "*bias -= 1.05f * HK_BIAS_GAIN"),
        ),
        (
            design(more=more_parameters(bias_deg_s=(1.5, -0.75))),
            (
                "hk_filter.c",
                "settings->bias_rad_s[HK_PITCH] *",
                "settings->bias_rad_s[HK_ROLL] *",
            ),
        ),
    ],
)
def test_a_fault_is_found(
    host_cc, tmp_path: Path, code: FilterDesign, fault: tuple[str, str, str]
) -> None:
    rad, _, _ = response(host_cc, code, tmp_path, turning(), *fault)
    assert apart_deg(rad.astype(np.float64), modelled(code, turning())[0]) > TOLERANCE_DEG
