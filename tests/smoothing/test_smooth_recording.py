"""The smoother on whole recordings: gaps, uneven times, calibration, settings of its own, files."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from designs import design
from recorded import recorded

from hostkit.attitude import inclination_rad
from hostkit.errors import DesignError, RecordingError
from hostkit.recordings import Recording, load, save
from hostkit.records import Parameter
from hostkit.simulation import SensorErrors
from hostkit.smoothing import (
    KnownSensor,
    SmootherSettings,
    TrainingOptions,
    as_reference,
    known_sensor,
    load_settings,
    measured_reference,
    save_settings,
    save_smoothed,
    score,
    smooth,
    smooth_recording,
    train,
)
from hostkit.smoothing.automatic import is_planar
from hostkit.smoothing.stretches import stretches
from hostkit.units import DEG_PER_RAD, RAD_PER_DEG

DEFAULT = SmootherSettings()


@pytest.fixture(scope="module")
def free() -> Recording:
    return recorded("free", duration_s=20.0, errors=SensorErrors.none())


def taken(recording: Recording, rows: np.typing.NDArray[np.intp]) -> Recording:
    assert recording.up_reference is not None
    return replace(
        recording,
        time_s=recording.time_s[rows],
        angular_rate_rad_s=recording.angular_rate_rad_s[rows],
        specific_force_m_s2=recording.specific_force_m_s2[rows],
        up_reference=recording.up_reference[rows],
        valid=recording.valid[rows],
    )


def error_deg(recording: Recording, up: np.typing.NDArray[np.float64]) -> float:
    found = score(recording, up)
    assert found is not None
    return found.headline_rad() * DEG_PER_RAD


def test_a_whole_recording_is_smoothed_and_scored(free: Recording) -> None:
    found = smooth_recording(free, DEFAULT)
    assert (len(found.pieces), found.short, found.resampled) == (1, (), False)
    assert error_deg(free, found.up) < 0.7


def test_a_short_gap_is_bridged_and_doubted(free: Recording) -> None:
    rows = np.delete(np.arange(len(free)), slice(1000, 1008))
    found = smooth_recording(taken(free, rows), DEFAULT)
    assert (len(found.pieces), found.resampled) == (1, True)
    assert found.doubted_s == pytest.approx(0.08, abs=0.021)
    assert error_deg(taken(free, rows), found.up) < 1.0


def test_a_long_gap_cuts_and_what_is_too_short_has_no_tilt(free: Recording) -> None:
    holed = taken(free, np.r_[0:900, 1000:1100, 1200:2000])
    found = smooth_recording(holed, DEFAULT)
    assert [piece.rows for piece in found.pieces] == [slice(0, 900), slice(1000, 1800)]
    assert found.short == (slice(900, 1000),)
    assert np.isnan(found.up[900:1000]).all()
    assert np.isfinite(found.up[:900]).all()
    assert error_deg(holed, found.up) < 0.7


def test_only_short_pieces_are_refused_with_what_it_takes(free: Recording) -> None:
    with pytest.raises(RecordingError, match="longest of 1 s; smoothing takes 4"):
        smooth_recording(taken(free, np.r_[0:100, 200:300]), DEFAULT)


def test_uneven_times_are_evened(free: Recording) -> None:
    rng = np.random.default_rng(2)
    rows = np.sort(rng.permutation(len(free))[: len(free) * 4 // 5])
    found = smooth_recording(taken(free, rows), DEFAULT)
    assert found.resampled
    assert error_deg(taken(free, rows), found.up) < 2.0


def test_a_clock_with_jitter_below_half_a_step_is_even() -> None:
    time = np.arange(500) * 0.01
    (stretch,) = stretches(time + np.random.default_rng(0).uniform(-0.002, 0.002, 500))
    assert stretch.is_even
    assert stretch.period_s == pytest.approx(0.01, rel=1e-3)


def test_a_file_cannot_ask_for_more_samples_than_it_holds() -> None:
    steps = np.where(np.arange(1000) % 2, 1.25e-4, 0.2)
    steps[:10] = 1.25e-4
    assert sum(len(part.grid_s) for part in stretches(np.cumsum(steps))) < 30_000


def test_points_in_a_gap_are_doubted_and_no_others() -> None:
    (stretch,) = stretches(np.r_[0:100, 105:200] * 0.01)
    np.testing.assert_array_equal(np.flatnonzero(stretch.doubted), np.arange(100, 105))


def test_a_calibration_of_the_design_is_put_on_the_readings(free: Recording) -> None:
    scale, offset = np.array((0.1, -0.08, 0.05)), np.array((0.8, -0.6, 0.5))
    off = replace(
        free,
        angular_rate_rad_s=free.angular_rate_rad_s / (1.0 + scale),
        specific_force_m_s2=free.specific_force_m_s2 + offset,
    )
    named = zip("xyz", scale, offset, strict=True)
    parameters = [
        parameter
        for axis, s, o in named
        for parameter in (
            Parameter(name=f"gyro_scale_{axis}", value=float(s), unit="1"),
            Parameter(name=f"accel_offset_{axis}_m_s2", value=float(o), unit="m/s^2"),
        )
    ]
    lead = Parameter(name="lead_s", value=0.002, unit="s")
    known = known_sensor(replace(design(), parameters=(*parameters, lead)))
    assert known.lead_s == 0.002
    told = smooth_recording(off, DEFAULT, replace(known, lead_s=None))
    assert error_deg(off, told.up) < 0.2 * error_deg(off, smooth_recording(off, DEFAULT).up)


def test_the_full_scale_of_the_design_marks_clipped_rates(free: Recording) -> None:
    known = KnownSensor(gyro_full_scale_rad_s=0.5)
    clipped = np.any(np.abs(free.angular_rate_rad_s[1:]) >= 0.5, axis=1)
    assert clipped.any()
    found = smooth_recording(free, DEFAULT, known)
    assert found.doubted_s == pytest.approx(clipped.sum() * 0.01, abs=0.011)


def test_a_coarse_sensor_chooses_other_settings_and_gains(free: Recording) -> None:
    rng = np.random.default_rng(3)
    rate = free.angular_rate_rad_s * 1.25 + rng.normal(0.0, 2.0 * RAD_PER_DEG, (len(free), 3))
    coarse = replace(free, angular_rate_rad_s=rate)
    told, chosen = smooth_recording(coarse, DEFAULT), smooth_recording(coarse)
    assert chosen.pieces[0].smoothed.compared > 3
    assert chosen.pieces[0].smoothed.settings != DEFAULT
    assert error_deg(coarse, chosen.up) < 0.5 * error_deg(coarse, told.up)


def test_a_good_sensor_keeps_the_defaults(free: Recording) -> None:
    found = smooth_recording(free)
    assert found.pieces[0].smoothed.settings == DEFAULT


def test_planar_motion_holds_the_scale_of_the_gyroscope(free: Recording) -> None:
    assert not is_planar(free.angular_rate_rad_s)
    swing = np.zeros((1000, 3))
    swing[:, 2] = 2.0 * np.sin(np.arange(1000) * 0.05)
    assert is_planar(swing + np.array((0.3, -0.2, 0.1)))
    force = np.tile((0.0, 9.80665, 0.0), (1000, 1))
    loose = replace(DEFAULT, gyro_scale=0.5)
    assert smooth(swing, force, 0.01, loose).settings.gyro_scale < 1e-3
    rate, force = free.angular_rate_rad_s, free.specific_force_m_s2
    assert smooth(rate, force, 0.01, loose).settings.gyro_scale == 0.5


@pytest.mark.parametrize("suffix", ["csv", "npz"])
def test_without_a_reference_the_smoothed_tilt_becomes_one(
    free: Recording, tmp_path: Path, suffix: str
) -> None:
    bare, path = replace(free, up_reference=None), tmp_path / f"out.{suffix}"
    up = smooth_recording(bare, DEFAULT).up
    up[:7] = np.nan
    save_smoothed(bare, up, path)
    back = load(path)
    assert back.up_reference is not None
    np.testing.assert_allclose(back.up_reference, up, atol=1e-12)
    assert measured_reference(back) is None
    assert score(back, up) is None
    again = as_reference(back, up)
    assert again.origin == back.origin


@pytest.mark.parametrize("suffix", ["csv", "npz"])
def test_a_measured_reference_stays(free: Recording, tmp_path: Path, suffix: str) -> None:
    path, plain = tmp_path / f"out.{suffix}", tmp_path / f"plain.{suffix}"
    up = smooth_recording(free, DEFAULT).up
    save_smoothed(free, up, path)
    save(free, plain)
    back, same = load(path), load(plain)
    np.testing.assert_array_equal(back.up_reference, same.up_reference)
    np.testing.assert_array_equal(back.angular_rate_rad_s, free.angular_rate_rad_s)
    if suffix == "npz":
        roll = np.load(path)["smooth_tilt_rad"][:, 0]
    else:
        roll = np.genfromtxt(path, delimiter=",", names=True, skip_header=4)["smooth_roll_rad"]
    np.testing.assert_array_equal(roll, np.arctan2(up[:, 1], up[:, 2]))


def test_settings_come_back_from_their_file(tmp_path: Path) -> None:
    settings = replace(DEFAULT, gyro_scale=0.3, lead_s=0.002)
    save_settings(settings, None, tmp_path / "s.json")
    assert load_settings(tmp_path / "s.json") == settings


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("{", "not strict JSON"),
        ('{"schema": "hostkit.smoother/1", "schema": "x"}', "twice"),
        ('{"schema": "other/1"}', "schema is 'other/1'"),
        ('{"schema": "hostkit.smoother/1", "extra": 1}', "unknown key 'extra'"),
        ('{"schema": "hostkit.smoother/1", "settings": []}', "must be an object"),
        ('{"schema": "hostkit.smoother/1", "settings": {"speed": 1}}', "unknown key 'speed'"),
        ('{"schema": "hostkit.smoother/1", "settings": {"speed_m_s": "1"}}', "must be a number"),
        ('{"schema": "hostkit.smoother/1", "settings": {"speed_m_s": NaN}}', "NaN"),
        ('{"schema": "hostkit.smoother/1", "settings": {"speed_m_s": 1e400}}', "a number"),
        ('{"schema": "hostkit.smoother/1", "settings": {"speed_m_s": 0}}', "outside"),
        ("[" * 100_000, "not strict JSON"),
    ],
)
def test_a_bad_settings_file_is_refused(tmp_path: Path, text: str, reason: str) -> None:
    path = tmp_path / "s.json"
    path.write_text(text)
    with pytest.raises(DesignError, match=reason):
        load_settings(path)


def test_training_improves_and_says_what_is_held_out(free: Recording) -> None:
    rng = np.random.default_rng(4)
    coarse = []
    for rows in (np.arange(800), np.arange(1000, 1800)):
        part = taken(free, rows)
        noise = rng.normal(0.0, 2.0 * RAD_PER_DEG, (len(part), 3))
        coarse.append(replace(part, angular_rate_rad_s=part.angular_rate_rad_s * 1.25 + noise))
    trained = train(coarse, TrainingOptions(evaluations=40))
    untrained = np.mean([error_deg(r, smooth_recording(r, DEFAULT).up) for r in coarse])
    assert trained.rmse_rad * DEG_PER_RAD < 0.5 * untrained
    assert (trained.folds, len(trained.held_out_rad)) == (2, 2)
    assert max(trained.held_out_rad) * DEG_PER_RAD < untrained


def test_training_needs_measured_references(free: Recording) -> None:
    assert free.up_reference is not None
    for bare in (replace(free, up_reference=None), as_reference(free, free.up_reference)):
        with pytest.raises(RecordingError, match="no measured reference"):
            train([bare], TrainingOptions())
    with pytest.raises(RecordingError, match="too few to train"):
        train([free], TrainingOptions(evaluations=3))


def test_the_smoothed_tilt_serves_as_a_reference(free: Recording) -> None:
    assert free.up_reference is not None
    pseudo = as_reference(free, smooth_recording(free).up)
    assert pseudo.up_reference is not None
    apart = inclination_rad(pseudo.up_reference, free.up_reference)
    assert np.degrees(np.sqrt(np.mean(apart**2))) < 0.7


def test_a_settings_file_has_its_provenance(free: Recording, tmp_path: Path) -> None:
    from hostkit.smoothing.provenance import provenance

    options = TrainingOptions(evaluations=40)
    short = replace(taken(free, np.arange(500)), sha256="ab" * 32)
    trained = train([short], options)
    found = provenance(trained, options, [short])
    save_settings(trained.settings, found, tmp_path / "s.json")
    training = json.loads((tmp_path / "s.json").read_text())["training"]
    assert training["recordings"][0]["sha256"] == "ab" * 32
    assert training["held_out_rmse_deg"] is None
    assert training["evaluations"] == trained.evaluations
