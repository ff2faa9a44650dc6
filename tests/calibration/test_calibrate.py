"""The calibration on a simulated sensor, whose errors are known."""

from dataclasses import replace

import numpy as np
import pytest
from calibration_cases import DEG, ERRORS, FACES, HOLD_S, MANY, posed, true_terms

from hostkit.calibration import Calibration, calibrate, rms, to_record
from hostkit.calibration.remarks import remarks, require_accelerometer
from hostkit.errors import CalibrationError
from hostkit.recordings import Recording
from hostkit.simulation import SensorErrors
from hostkit.units import STANDARD_GRAVITY_M_S2


def deviations(found: Calibration, errors: SensorErrors = ERRORS) -> np.ndarray:
    """How many standard errors each term is from the truth."""
    truth = true_terms(errors)
    return np.array([(t.value - truth[t.kind][t.axis]) / t.standard_error for t in found.terms])


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_many_poses_give_every_term_within_its_error(seed: int) -> None:
    found = calibrate((posed(MANY, seed=seed),))
    assert len(found.poses) == len(MANY)
    assert len(found.turns) == len(MANY) - 1
    assert [t.name for t in found.terms] == [
        f"{kind}_{axis}"
        for kind in ("gyro_bias", "gyro_scale", "accel_offset", "accel_scale")
        for axis in "xyz"
    ]
    assert np.abs(deviations(found)).max() < 3.0
    assert np.sqrt(np.mean(deviations(found) ** 2)) < 1.5
    assert max(t.standard_error for t in found.terms if "scale" in t.kind) < 0.003


def test_axes_that_are_not_square_do_not_pass_for_offset_or_scale() -> None:
    errors = replace(ERRORS, cross_axis=0.01)
    found = calibrate((posed(MANY, errors),))
    assert np.abs(deviations(found, errors)).max() < 3.0
    np.testing.assert_allclose(found.accel.skew_rad, -0.01, atol=0.002)
    assert rms(found.accel.model_m_s2) < 0.1 * rms(found.accel.after_m_s2)
    assert rms(found.gyro.model_rad) < 0.5 * rms(found.gyro.after_rad)
    assert any("deg from square" in remark for remark in remarks(found))


def test_six_faces_give_the_accelerometer_and_the_axes_that_were_turned() -> None:
    found = calibrate((posed(FACES),))
    assert found.accel.determined
    assert found.missing == ()
    assert np.abs(deviations(found)).max() < 3.0
    assert found.gyro.determined.tolist() == [True, True, False]
    (said,) = (remark for remark in remarks(found) if "gyro_scale" in remark)
    assert "gyro_scale_z is not determined" in said
    assert "about z held level" in said


@pytest.mark.parametrize(
    ("left_out", "missing"),
    [(2, "-z up"), (5, "+x up"), (1, "+y up")],
)
def test_a_missing_face_is_named(left_out: int, missing: str) -> None:
    poses = tuple(pose for i, pose in enumerate(FACES) if i != left_out)
    found = calibrate((posed(poses),))
    assert found.missing == (missing,)
    assert not [t for t in found.terms if t.kind.startswith("accel")]
    with pytest.raises(CalibrationError, match=rf"5 poses.*with \{missing}.*--sensors gyro"):
        require_accelerometer(found)


def test_one_position_gives_the_bias_alone() -> None:
    found = calibrate((posed(((0, 0, 0),)),))
    assert [t.name for t in found.terms] == ["gyro_bias_x", "gyro_bias_y", "gyro_bias_z"]
    np.testing.assert_allclose(found.gyro.bias_rad_s, ERRORS.gyro_bias_rad_s, atol=0.02 * DEG)
    assert len(found.missing) == 5
    assert "+z up" not in found.missing


def test_recordings_of_single_positions_add_up() -> None:
    parts = tuple(posed((face,), seed=i) for i, face in enumerate(FACES))
    found = calibrate(parts)
    assert found.accel.determined
    assert found.turns == ()
    assert [recording.samples for recording in found.recordings] == [len(p) for p in parts]
    assert np.abs(deviations(found)).max() < 3.0


def test_another_gravity_scales_the_accelerometer() -> None:
    found = calibrate((posed(FACES),), gravity_m_s2=9.78)
    standard = calibrate((posed(FACES),))
    ratio = (1.0 + found.accel.scale) / (1.0 + standard.accel.scale)
    np.testing.assert_allclose(ratio, 9.78 / STANDARD_GRAVITY_M_S2, rtol=1e-5)
    assert to_record(found).gravity_m_s2 == 9.78


def test_a_bad_pose_is_left_out_and_said() -> None:
    recording = posed(MANY)
    force = recording.specific_force_m_s2.copy()
    third = (recording.time_s > 2 * HOLD_S - 0.5) & (recording.time_s < 3 * HOLD_S - 2.2)
    force[third] *= 1.06
    found = calibrate((replace(recording, specific_force_m_s2=force),))
    begin_s = [pose.begin_s for pose in found.poses]
    bad = [b for b, used in zip(begin_s, found.accel.used.tolist(), strict=True) if not used]
    assert len(bad) == 1
    assert 2 * HOLD_S - 0.5 < bad[0] < 3 * HOLD_S
    assert np.abs(deviations(found)[6:]).max() < 3.0
    assert any("is left out: its force is off" in remark for remark in remarks(found))


def test_a_sensor_that_never_rests_is_refused() -> None:
    time_s = np.arange(1000) / 100.0
    rate = np.stack([np.sin(3.0 * time_s + phase) for phase in range(3)], axis=1)
    moved = replace(posed(FACES, seed=1), name="shaken")
    shaken = Recording(
        name=moved.name,
        time_s=time_s,
        rate_hz=100.0,
        angular_rate_rad_s=rate,
        specific_force_m_s2=9.8 * rate,
        valid=np.ones(1000, dtype=np.bool_),
    )
    with pytest.raises(CalibrationError, match="never at rest for a second in shaken"):
        calibrate((shaken,))


def test_a_steady_turn_is_no_pose() -> None:
    recording = posed(MANY)
    rate = recording.angular_rate_rad_s.copy()
    fourth = (recording.time_s > 3 * HOLD_S) & (recording.time_s < 4 * HOLD_S)
    rate[fourth, 2] += 5.0 * DEG
    found = calibrate((replace(recording, angular_rate_rad_s=rate),))
    assert not [p for p in found.poses if 3 * HOLD_S < p.begin_s + 0.5 < 4 * HOLD_S - 1.0]
    assert len(found.poses) >= len(MANY) - 2


@pytest.mark.parametrize("axis", [0, 1])
def test_a_gyroscope_of_the_wrong_sign_is_refused(axis: int) -> None:
    recording = posed(MANY)
    rate = recording.angular_rate_rad_s.copy()
    rate[:, axis] *= -1.0
    with pytest.raises(CalibrationError, match=r"contradict each other|the sign with which"):
        calibrate((replace(recording, angular_rate_rad_s=rate),))


def test_a_wrong_range_of_the_accelerometer_is_refused() -> None:
    recording = posed(FACES)
    doubled = replace(recording, specific_force_m_s2=2.0 * recording.specific_force_m_s2)
    with pytest.raises(CalibrationError, match=r"axis would be off by -5. %; the limit is 25 %"):
        calibrate((doubled,))


def test_turns_beyond_the_range_or_across_a_gap_are_not_used() -> None:
    recording = posed(MANY)
    rate = recording.angular_rate_rad_s.copy()
    rate[:, 0] = np.clip(rate[:, 0], -60.0 * DEG, 60.0 * DEG)
    clipped = calibrate((replace(recording, angular_rate_rad_s=rate),))
    assert 0 < len(clipped.turns) < len(MANY) - 1
    later = recording.time_s + np.where(recording.time_s > 1.75 * HOLD_S, 5.0, 0.0)
    gap = calibrate((replace(recording, time_s=later),))
    assert len(gap.turns) == len(MANY) - 2


def test_temperature_is_that_at_rest() -> None:
    recording = posed(FACES)
    warm = replace(recording, temperature_deg_c=25.0 + 0.1 * recording.time_s)
    record = to_record(calibrate((warm,)))
    assert record.temperature_c is not None
    assert record.temperature_low_c == pytest.approx(25.0, abs=0.05)
    assert record.temperature_high_c == pytest.approx(25.0 + 0.1 * recording.time_s[-1], abs=0.05)
    assert record.temperature_low_c < record.temperature_c < record.temperature_high_c
    assert to_record(calibrate((recording,))).temperature_c is None
