"""When a line of the diagnosis asks for something."""

from dataclasses import replace

import numpy as np
import pytest
from diagnosis_cases import Simulate, Still

from hostkit.diagnosis import diagnose, findings
from hostkit.recordings import Recording
from hostkit.simulation import SensorErrors
from hostkit.units import RAD_PER_DEG, STANDARD_GRAVITY_M_S2


def levels(recording: Recording) -> dict[str, str]:
    return {f.topic: f.level for f in findings(diagnose(recording))}


def shaken(still: Still, rms_m_s2: float) -> Recording:
    force = np.tile((0.0, 0.0, STANDARD_GRAVITY_M_S2), (2000, 1))
    force[:, 0] = np.sqrt(2.0) * rms_m_s2 * np.sin(2.0 * np.pi * 0.3 * np.arange(2000))
    return still(2000, specific_force_m_s2=force)


def test_every_look_has_an_action_and_no_ok_has_one(moved: Simulate, still: Still) -> None:
    for recording in (moved("free", 30.0), moved("rest", 40.0), shaken(still, 0.6)):
        for finding in findings(diagnose(recording, noise=True)):
            assert (finding.level == "look") == bool(finding.action)
            assert finding.line().startswith("!" if finding.action else " ")
            assert "\n" not in finding.line()


def test_no_gate_is_asked_of_a_motion_for_the_observer(moved: Simulate) -> None:
    found = {f.topic: f for f in findings(diagnose(moved("free", 30.0)))}
    assert "--filter observer" in found["motion"].action
    assert "up to 0.1" in found["force"].sentence
    assert found["force"].action == ""


@pytest.mark.parametrize(("bias_deg_s", "level"), [(0.9, "ok"), (-1.1, "look")])
def test_bias(moved: Simulate, bias_deg_s: float, level: str) -> None:
    errors = replace(SensorErrors.none(), gyro_bias_rad_s=(0.0, bias_deg_s * RAD_PER_DEG, 0.0))
    assert levels(moved("rest", 20.0, errors))["bias"] == level


@pytest.mark.parametrize(("error", "level"), [(0.02, "ok"), (0.04, "look"), (-0.04, "look")])
def test_gravity(moved: Simulate, error: float, level: str) -> None:
    errors = replace(SensorErrors.none(), accel_scale=(0.0, 0.0, error))
    assert levels(moved("rest", 20.0, errors))["gravity"] == level


def test_gravity_that_differs_between_orientations(still: Still) -> None:
    force = np.tile((0.0, 0.0, STANDARD_GRAVITY_M_S2), (2000, 1))
    force[1000:] = (1.02 * STANDARD_GRAVITY_M_S2, 0.0, 0.0)
    rate = np.zeros((2000, 3))
    rate[950:1050, 1] = -np.pi / 2.0
    parted = still(2000, specific_force_m_s2=force, angular_rate_rad_s=rate)
    assert levels(parted)["gravity"] == "look"
    assert diagnose(parted).rest.force_spread == pytest.approx(0.02)


@pytest.mark.parametrize(("rms_m_s2", "level"), [(0.4, "ok"), (0.6, "look")])
def test_vibration(still: Still, rms_m_s2: float, level: str) -> None:
    assert levels(shaken(still, rms_m_s2))["vibration"] == level


@pytest.mark.parametrize(("span_deg_c", "level"), [(4.0, "ok"), (6.0, "look")])
def test_temperature(still: Still, span_deg_c: float, level: str) -> None:
    temperature = 20.0 + np.linspace(0.0, span_deg_c, 500)
    temperature[7] = np.nan
    recording = still(500, temperature_deg_c=temperature)
    assert levels(recording)["temperature"] == level
    assert diagnose(recording).temperature_deg_c == pytest.approx((20.0, 20.0 + span_deg_c))
    assert "temperature" not in levels(still(500))


def test_time(still: Still) -> None:
    assert levels(still(500))["time"] == "ok"
    late = np.arange(500) / 100.0 + np.where(np.arange(500) > 250, 1.0, 0.0)
    assert levels(still(500, time_s=late))["time"] == "look"
    uneven = np.arange(500) / 100.0 + 0.002 * (np.arange(500) % 2)
    assert levels(still(500, time_s=uneven))["time"] == "look"


def test_calm_motion_with_the_accelerometer_alone_is_said(moved: Simulate) -> None:
    """Without linear acceleration the gyroscope plays no part, and the verdict says little."""
    found = {f.topic: f for f in findings(diagnose(moved("random", 60.0)))}["motion"]
    assert found.sentence.startswith("two axes suffice")
    assert "the accelerometer alone is best here" in found.action
