"""The verdict on the motion: its equations, its figures and its limits."""

from dataclasses import replace

import numpy as np
import pytest
from diagnosis_cases import SENSOR, Simulate
from scipy.spatial.transform import Rotation

from hostkit.attitude import inclination_rad, pitch_from_up, roll_from_up, up_from_tilt, wrap_rad
from hostkit.diagnosis import Planarity, diagnose
from hostkit.diagnosis.coupling import axis_motions
from hostkit.diagnosis.planarity import planarity
from hostkit.diagnosis.strapdown import strapdown
from hostkit.filters.complementary import eta_from_tau, parameters
from hostkit.mounting import Mounting
from hostkit.recordings import Recording
from hostkit.records import AxisChoice, FilterDesign
from hostkit.simulation import SensorErrors
from hostkit.tuning import evaluate
from hostkit.units import DEG_PER_RAD

NO_BIAS = np.zeros(3)
NONE = SensorErrors.none()


def judge(recording: Recording, axes: AxisChoice = "both", mounting: str = "+x+y+z") -> Planarity:
    return diagnose(recording, axes=axes, mounting=Mounting.parse(mounting)).planarity


def obtained_rad(recording: Recording, axes: AxisChoice, tau_s: float) -> float:
    """What the device's filter really gets on a recording with a time constant."""
    design = FilterDesign(
        filter="complementary",
        axes=axes,
        tilt="atan2",
        mounting=Mounting(),
        rate_hz=recording.rate_hz,
        sensor=SENSOR,
        parameters=parameters(eta_from_tau(tau_s, 1.0 / recording.rate_hz)),
    )
    score = evaluate(design, recording).score("inclination" if axes == "both" else axes)
    assert score is not None
    return score.rms_rad


def test_rate_error_is_that_of_the_euler_angles() -> None:
    """At steps so small that the turn of up is a differential."""
    rng = np.random.default_rng(2)
    roll, pitch = rng.uniform(-1.0, 1.0, (2, 50))
    rate = rng.uniform(-2.0, 2.0, (50, 3))
    up = np.repeat(up_from_tilt(roll, pitch), 2, axis=0)
    rates, period_s = np.repeat(rate, 2, axis=0), 1e-6
    of_roll, of_pitch = axis_motions(
        ("roll", "pitch"), up=up, rate_rad_s=rates, force_m_s2=up, period_s=period_s
    )
    p, q, r = rate.T
    roll_rate = p + (q * np.sin(roll) + r * np.cos(roll)) * np.tan(pitch)
    pitch_rate = q * np.cos(roll) - r * np.sin(roll)
    np.testing.assert_allclose(of_roll.coupling[1::2] / period_s, p - roll_rate, atol=1e-4)
    np.testing.assert_allclose(of_pitch.coupling[1::2] / period_s, q - pitch_rate, atol=1e-4)


def test_coupling_of_large_steps_at_any_attitude() -> None:
    """Half a radian a step, upside down too, against scipy's rotations."""
    rng = np.random.default_rng(8)
    up = rng.standard_normal((400, 3))
    up /= np.linalg.norm(up, axis=1, keepdims=True)
    turn = rng.uniform(-0.5, 0.5, (400, 3))
    ahead = Rotation.from_rotvec(-turn).apply(up)
    for axis, index, angle in (("roll", 0, roll_from_up), ("pitch", 1, pitch_from_up)):
        (motion,) = axis_motions(
            (axis,),  # type: ignore[arg-type]
            up=np.stack((up, ahead), axis=1).reshape(-1, 3),
            rate_rad_s=np.repeat(turn, 2, axis=0),
            force_m_s2=np.repeat(up, 2, axis=0),
            period_s=1.0,
        )
        turned = wrap_rad(angle(ahead) - angle(up))
        np.testing.assert_allclose(motion.coupling[1::2], turn[:, index] - turned, atol=1e-9)
        np.testing.assert_allclose(motion.drive[1::2], turn[:, index] - turned, atol=1e-9)


@pytest.mark.parametrize("profile", ["free", "planar", "random"])
@pytest.mark.parametrize("axes", ["both", "roll", "pitch"])
def test_predicted_error_is_what_the_filter_gets(
    moved: Simulate, profile: str, axes: AxisChoice
) -> None:
    """The filter runs in integers on counts; 0.02 deg are between them."""
    recording = moved(profile, 60.0, NONE)
    errors = planarity(recording, axes=axes, mounting=Mounting(), bias_rad_s=NO_BIAS).errors
    assert errors.predicted_rad == pytest.approx(
        obtained_rad(recording, axes, errors.tau_s), abs=3e-4, rel=0.01
    )


def test_predicted_tau_is_near_the_best(moved: Simulate) -> None:
    recording = moved("planar", 60.0, NONE)
    errors = planarity(recording, axes="roll", mounting=Mounting(), bias_rad_s=NO_BIAS).errors
    for factor in (0.3, 3.0):
        assert obtained_rad(recording, "roll", errors.tau_s * factor) > errors.predicted_rad


def test_roll_alone_is_planar_with_or_without_reference(moved: Simulate) -> None:
    recording = moved("planar", 60.0)
    for case in (recording, replace(recording, up_reference=None)):
        found = judge(case, "roll")
        assert found.verdict == "planar"
        assert found.errors.extra_rad * DEG_PER_RAD < 0.2
        assert found.turn_share[0] > 0.98
        assert judge(case, "both").verdict == "planar"


def test_free_motion_needs_three_dimensions_with_or_without_reference(moved: Simulate) -> None:
    recording = moved("free", 60.0)
    seen = judge(recording)
    blind = judge(replace(recording, up_reference=None))
    assert (seen.tilt, blind.tilt) == ("reference", "estimate")
    for found in (seen, blind):
        assert found.verdict == "needs a three-dimensional filter"
        assert found.errors.spatial_rad * DEG_PER_RAD < 2.0
    assert blind.errors.extra_rad == pytest.approx(seen.errors.extra_rad, rel=0.1)


def test_a_planar_motion_seen_as_the_wrong_axis_is_not_planar(moved: Simulate) -> None:
    """Swung about sensor x: roll with any mounting that has x first, not with z first."""
    recording = moved("planar", 60.0)
    assert judge(recording, "roll", "+x-y-z").verdict == "planar"
    assert judge(recording, "roll", "+z+x+y").verdict == "needs a three-dimensional filter"


def test_small_motion_about_two_axes_suffices(moved: Simulate) -> None:
    recording = moved("random", 60.0, NONE)
    assert judge(recording).verdict == "two axes suffice"


def test_quick_motion_about_two_axes_does_not(moved: Simulate) -> None:
    """The sweep reaches 1.5 Hz with 30 deg: 1.15 deg come from the other axis, the limit is 1."""
    found = judge(moved("sine-sweep", 60.0))
    assert found.verdict == "needs a three-dimensional filter"
    assert found.errors.extra_rad * DEG_PER_RAD == pytest.approx(1.15, abs=0.1)


def test_rest_is_not_judged(moved: Simulate) -> None:
    assert judge(moved("rest", 20.0)).verdict is None


def test_reference_in_part_is_filled_and_scored_in_part(moved: Simulate) -> None:
    recording = moved("free", 60.0)
    assert recording.up_reference is not None
    up = recording.up_reference.copy()
    up[1000:3000] = np.nan
    found = judge(replace(recording, up_reference=up))
    assert (found.tilt, found.scored) == ("reference", 4000)
    nothing_valid = replace(recording, valid=np.zeros(6000, dtype=np.bool_))
    assert judge(nothing_valid).scored == 6000


def test_extra_is_bounded_by_the_neglect_itself(moved: Simulate) -> None:
    """Strong accelerations part the two filters; that is not the neglected rates' doing."""
    recording = moved("planar", 60.0)
    errors = judge(recording, "roll").errors
    harsh = replace(errors, predicted_rad=5.0 * errors.spatial_rad)
    assert harsh.extra_rad == errors.neglect_rad < 0.01
    added = np.sqrt(errors.predicted_rad**2 - (0.5 * errors.predicted_rad) ** 2)
    free = replace(errors, spatial_rad=0.5 * errors.predicted_rad, neglect_rad=1.0)
    assert free.extra_rad == pytest.approx(added)
    assert replace(errors, spatial_rad=1.0).extra_rad == 0.0


@pytest.mark.parametrize("samples", [2, 3, 16, 17, 1000])
def test_strapdown_multiplies_every_step(samples: int, still: Simulate) -> None:
    """Against scipy, one rotation after the other."""
    rate = np.random.default_rng(6).uniform(-20.0, 20.0, (samples, 3))
    force = np.random.default_rng(7).standard_normal((samples, 3))
    bias = np.array((0.5, -0.2, 0.1))
    recording = still(samples, angular_rate_rad_s=rate, specific_force_m_s2=force)
    found = strapdown(recording, bias)
    turn, expected = Rotation.identity(), []
    for k in range(samples):
        if k:
            turn *= Rotation.from_rotvec((rate[k] - bias) * 0.01)
        expected.append(turn.apply(force[k]))
    np.testing.assert_allclose(found.force_m_s2, expected, atol=1e-9)
    np.testing.assert_allclose(found.to_sensor(found.force_m_s2), force, atol=1e-9)
    np.testing.assert_allclose(found.to_frame(force), found.force_m_s2, atol=1e-12)


def test_filtered_up_is_the_complementary_filter(moved: Simulate) -> None:
    """One step in sensor axes: turn the last estimate, blend in the force."""
    recording = moved("free", 30.0)
    frame, eta = strapdown(recording, NO_BIAS), 0.995
    force = recording.specific_force_m_s2
    turn = Rotation.from_rotvec(-recording.angular_rate_rad_s * 0.01)
    vector = force[0].copy()
    for k in range(1, 200):
        vector = eta * turn[k].apply(vector) + (1.0 - eta) * force[k]
    got = frame.to_sensor(frame.filtered_up(eta))[199]
    np.testing.assert_allclose(got, vector / np.linalg.norm(vector), atol=1e-9)


def test_estimate_is_near_the_truth(moved: Simulate) -> None:
    recording = moved("free", 60.0, NONE)
    frame = strapdown(recording, NO_BIAS)
    up = frame.to_sensor(frame.smoothed_up(100.0))
    assert recording.up_reference is not None
    error = inclination_rad(up, recording.up_reference)
    alone = inclination_rad(recording.specific_force_m_s2, recording.up_reference)
    rms, alone_rms = (np.sqrt(np.mean(e**2)) * DEG_PER_RAD for e in (error, alone))
    assert rms < 0.6
    assert alone_rms > 4.0


def test_wrapped_error_follows_the_filter_where_angles_turn_over() -> None:
    """Rolling over and over with a gyroscope 20 % short: innovations exceed half a turn."""
    samples, period_s = 4000, 0.01
    roll = 3.0 * np.arange(samples) * period_s
    up = up_from_tilt(roll, np.zeros(samples))
    rate = np.zeros((samples, 3))
    rate[:, 0] = 2.4
    (motion,) = axis_motions(("roll",), up=up, rate_rad_s=rate, force_m_s2=up, period_s=period_s)
    eta, angle, expected = 0.9995, 0.0, [0.0]
    for k in range(1, samples):
        angle += 2.4 * period_s
        angle += (1.0 - eta) * ((roll[k] - angle + np.pi) % (2.0 * np.pi) - np.pi)
        expected.append(angle - roll[k])
    wrap = np.exp(1j * motion.wrapped_error_rad(eta))
    np.testing.assert_allclose(wrap, np.exp(1j * np.array(expected)), atol=1e-9)
    assert np.abs(np.exp(1j * motion.error_rad(eta)) - wrap).max() > 0.1


def test_spread_of_the_angles(moved: Simulate) -> None:
    recording = moved("random", 60.0, NONE)
    found = judge(recording)
    assert recording.up_reference is not None
    assert found.roll_spread_rad == pytest.approx(
        np.std(roll_from_up(recording.up_reference)), rel=0.05
    )
    assert found.pitch_spread_rad == pytest.approx(
        np.std(pitch_from_up(recording.up_reference)), rel=0.05
    )


def test_turning_about_the_vertical_is_told_from_tilting(still: Simulate) -> None:
    rate = np.zeros((500, 3))
    rate[:, 2] = 1.0
    found = planarity(
        still(500, angular_rate_rad_s=rate), axes="both", mounting=Mounting(), bias_rad_s=NO_BIAS
    )
    assert found.turn_share == (0.0, 0.0, 1.0)
    assert found.turn_upright == pytest.approx(1.0)
