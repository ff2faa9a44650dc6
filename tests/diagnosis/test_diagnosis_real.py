"""The verdict on real recordings, and its prediction against what the filter gets on them."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from hostkit.diagnosis import diagnose
from hostkit.filters.complementary import eta_from_tau, parameters
from hostkit.mounting import Mounting
from hostkit.recordings import load
from hostkit.records import AxisChoice, FilterDesign, SensorConfig
from hostkit.tuning import evaluate

WIDEST = SensorConfig(
    part="mpu6050", gyro_full_scale_deg_s=2000, accel_full_scale_g=16, low_pass_setting=3
)
SWING = Mounting.parse("+z+x+y")
LEVEL = Mounting()


@pytest.mark.parametrize(
    ("name", "axes", "mounting"),
    [
        ("repoimu_pendulum/Pendulum_Test06_Trial2_Segment_3", "roll", SWING),
        ("repoimu_pendulum/Pendulum_Test06_Trial2_Segment_3", "both", SWING),
        ("broad/06_undisturbed_fast_rotation_A", "both", LEVEL),
        ("broad/11_undisturbed_slow_translation_B", "roll", LEVEL),
        ("repoimu_tstick/TStick_Test11_Trial1", "both", LEVEL),
        ("robot_mpu/MPU6050RM3100_V_300_seq4", "both", LEVEL),
        ("robot_mpu/MPU9150_eV50p_seq3", "pitch", LEVEL),
        ("upenn_arduimu/set03", "both", LEVEL),
    ],
)
def test_predicted_error_is_what_the_filter_gets(
    data_folder: Path, name: str, axes: AxisChoice, mounting: Mounting
) -> None:
    """At the time constant of the diagnosis, with the bias taken off that it found."""
    recording = load(data_folder / f"{name}.npz")
    diagnosis = diagnose(recording, axes=axes, mounting=mounting)
    errors = diagnosis.planarity.errors
    bias = np.array(diagnosis.rest.bias_rad_s or (0.0, 0.0, 0.0))
    unbiased = replace(recording, angular_rate_rad_s=recording.angular_rate_rad_s - bias)
    design = FilterDesign(
        filter="complementary",
        axes=axes,
        tilt="atan2",
        mounting=mounting,
        rate_hz=recording.rate_hz,
        sensor=WIDEST,
        parameters=parameters(eta_from_tau(errors.tau_s, 1.0 / recording.rate_hz)),
    )
    score = evaluate(design, unbiased).score("inclination" if axes == "both" else axes)
    assert score is not None
    assert errors.predicted_rad == pytest.approx(score.rms_rad, rel=0.01)


@pytest.mark.parametrize("with_reference", [True, False])
@pytest.mark.parametrize(
    ("folder", "axes", "mounting", "verdict"),
    [
        ("repoimu_pendulum", "roll", SWING, "planar"),
        ("repoimu_pendulum", "both", LEVEL, "needs a three-dimensional filter"),
        ("broad", "both", LEVEL, "needs a three-dimensional filter"),
        ("robot_mpu", "both", LEVEL, "needs a three-dimensional filter"),
    ],
)
def test_sets_are_told_apart(
    data_folder: Path,
    folder: str,
    axes: AxisChoice,
    mounting: Mounting,
    verdict: str,
    with_reference: bool,
) -> None:
    paths = sorted((data_folder / folder).glob("*.npz"))[::2]
    assert len(paths) >= 10
    for path in paths:
        recording = load(path)
        if not with_reference:
            recording = replace(recording, up_reference=None)
        found = diagnose(recording, axes=axes, mounting=mounting)
        assert found.planarity.verdict == verdict, path.name


def test_pendulum_in_another_mounting_is_pointed_to_its_axis(data_folder: Path) -> None:
    path = data_folder / "repoimu_pendulum" / "Pendulum_Test06_Trial2_Segment_3.npz"
    planarity = diagnose(load(path)).planarity
    assert planarity.turn_share[2] > 0.9
    assert planarity.turn_upright < 0.1
