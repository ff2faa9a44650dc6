"""``hostkit calibrate imu`` as it is called."""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from calibration_cases import ERRORS, FACES, MANY, posed, true_terms
from designs import design

from hostkit.attitude import inclination_rad, up_from_tilt
from hostkit.cli.main import run
from hostkit.design_file import design_text, digest, from_document, load_design, save_design
from hostkit.errors import DesignError
from hostkit.filters import FILTERS
from hostkit.filters.complementary import parameter
from hostkit.filters.observer import default_parameters
from hostkit.filters.sensor_terms import Calibrated, take_no_terms, take_sensor_terms
from hostkit.provenance import TERM_UNITS, CalibrationTerm
from hostkit.recordings import Recording, save
from hostkit.records import FilterDesign
from hostkit.units import DEG_PER_RAD, STANDARD_GRAVITY_M_S2

TERMS = tuple(
    CalibrationTerm(kind=kind, axis=axis, value=0.01 * (axis + 1) + 0.1 * i, standard_error=1e-3)
    for i, kind in enumerate(TERM_UNITS)
    for axis in range(3)
)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    save_design(design(), Path("design.json"))
    save(posed(MANY), Path("many.npz"))
    save(posed(FACES[:5]), Path("five.npz"))
    return tmp_path


def observer() -> FilterDesign:
    return replace(design(), filter="observer", parameters=default_parameters())


def taken(of: FilterDesign) -> Calibrated:
    return FILTERS[of.filter].calibrated(of, TERMS)


def test_the_document(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["calibrate", "imu", "design.json", "many.npz", "-o", "out.json", "--json"]) == 0
    said = capsys.readouterr()
    document = json.loads(said.out)
    assert document["schema"] == "hostkit.calibrate/1"
    written = load_design(Path("out.json"))
    assert document["digest"] == digest(written)
    assert document["taken"] == ["gyro_scale_x", "gyro_bias_x", "gyro_scale_y", "gyro_bias_y"]
    assert len(document["terms"]) == 12
    assert len(document["poses"]) == len(MANY)
    assert document["accelerometer"]["left_out_rms_m_s2"] < 0.01
    assert document["accelerometer"]["tilt_after_rms_deg"] < 0.2
    assert document["accelerometer"]["tilt_before_rms_deg"] > 2.0
    assert document["gyroscope"]["after_rms_deg"] < document["gyroscope"]["before_rms_deg"]
    (left_out,) = (text for text in document["warnings"] if "no place for" in text)
    assert "complementary filter" in left_out
    assert "accel_offset_x" in left_out
    assert f"note: {left_out}" in said.err
    truth = true_terms()
    assert written.parameter("gyro_scale_roll") == pytest.approx(truth["gyro_scale"][0], abs=3e-3)
    assert written.calibration is not None
    assert written.calibration.turns == len(MANY) - 1


def keys(value: object) -> set[str]:
    if isinstance(value, dict):
        return set(value) | {key for inner in value.values() for key in keys(inner)}
    if isinstance(value, list):
        return {key for inner in value for key in keys(inner)}
    return set()


def test_every_key_is_documented(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["calibrate", "imu", "design.json", "many.npz", "-o", "out.json", "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    page = (Path(__file__).resolve().parents[2] / "docs" / "calibration.md").read_text("utf-8")
    named = {*re.findall(r"`([a-z0-9_]+)`", page), "schema", *document["parameters"]}
    assert keys(document) - named == set()


def test_the_screen_and_the_report(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    line = ["calibrate", "imu", "design.json", "many.npz", "-o", "out.json", "--report", "r.html"]
    assert run(line) == 0
    said = capsys.readouterr().out
    assert "gyro_bias_x" in said
    assert "accel_scale_z" in said
    assert "not used" in said
    assert f"design {digest(load_design(Path('out.json')))}" in said
    page = Path("r.html").read_text(encoding="utf-8")
    assert "gyro_scale_x" in page
    assert page.count("<svg") == 2


def test_options_stand_in_the_project_file(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("hostkit.toml").write_text("[calibrate.imu]\ngravity-m-s2 = 9.78\n", encoding="utf-8")
    line = ["calibrate", "imu", "design.json", "many.npz", "-o", "out.json", "--json"]
    assert run(line) == 0
    assert json.loads(capsys.readouterr().out)["gravity_m_s2"] == 9.78
    Path("hostkit.toml").write_text("[calibrate.imu]\ngravity = 9.78\n", encoding="utf-8")
    assert run(line) == 1
    assert "has 'gravity' in [imu]" in capsys.readouterr().err


def test_missing_poses_are_refused_only_where_the_filter_has_a_place_for_them(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    line = ["calibrate", "imu", "design.json", "five.npz", "-o", "out.json"]
    assert run(line) == 0
    assert "poses are missing with +x up" in capsys.readouterr().err
    Path("out.json").unlink()
    save_design(observer(), Path("design.json"))
    assert run(line) == 1
    said = capsys.readouterr().err
    assert "5 poses do not determine the accelerometer" in said
    assert "+x up" in said
    assert not Path("out.json").exists()
    assert run([*line, "--sensors", "gyro"]) == 0
    names = {p.name for p in load_design(Path("out.json")).parameters}
    assert "gyro_bias_z_rad_s" in names
    assert "accel_offset_x_m_s2" not in names


def test_the_observer_takes_all_and_tells_the_tilt_at_rest(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Another recording of the sensor: only the calibrated design knows where up is."""
    save_design(observer(), Path("design.json"))
    line = ["calibrate", "imu", "design.json", "many.npz", "-o", "out.json", "--json"]
    assert run(line) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["taken"] == [term["name"] for term in document["terms"]]
    assert not [text for text in document["warnings"] if "no place" in text]
    other = posed(MANY[::-1], seed=9)
    before, after = (
        tilt_error_deg(load_design(Path(f)), other) for f in ("design.json", "out.json")
    )
    assert before > 1.5
    assert after < 0.35


def tilt_error_deg(of: FilterDesign, recording: Recording) -> float:
    force_g = recording.specific_force_m_s2 / STANDARD_GRAVITY_M_S2
    angles = FILTERS[of.filter].run_float(of, recording.angular_rate_rad_s, force_g)
    up = up_from_tilt(angles[:, 0], angles[:, 1])
    error = inclination_rad(up, recording.up_reference)
    return float(np.sqrt(np.mean(error**2))) * DEG_PER_RAD


def test_the_complementary_filter_takes_its_axes_through_the_mounting() -> None:
    found = taken(design(mounting="-x+y-z"))
    assert found.design.parameter("gyro_scale_roll") == 0.11
    assert found.design.parameter("gyro_bias_roll_rad_s") == pytest.approx(-0.01 * 1.11)
    assert found.design.parameter("gyro_bias_pitch_rad_s") == pytest.approx(0.02 * 1.12)
    assert set(found.taken) == {"gyro_bias_x", "gyro_scale_x", "gyro_bias_y", "gyro_scale_y"}
    turned = taken(design(mounting="+z+x+y", axes="roll"))
    assert set(turned.taken) == {"gyro_bias_z", "gyro_scale_z"}
    assert "gyro_bias_pitch_rad_s" not in {p.name for p in turned.design.parameters}


def test_a_scale_that_was_not_measured_stays() -> None:
    before = design(axes="roll", more=(parameter("gyro_scale", 0.2, "roll"),))
    bias = tuple(term for term in TERMS if term.kind == "gyro_bias")
    found = FILTERS["complementary"].calibrated(before, bias).design
    assert found.parameter("gyro_scale_roll") == 0.2
    assert found.parameter("gyro_bias_roll_rad_s") == pytest.approx(0.01 * 1.2)


def test_calibrated_rates_are_the_true_ones() -> None:
    """The float model with the terms turns as fast as the sensor did."""
    of = design(mounting="-x+y-z", eta=0.999999)
    rate = np.array((0.3, -0.2, 0.1)) * (1.0 + np.array(ERRORS.gyro_scale))
    reading = np.tile(rate + ERRORS.gyro_bias_rad_s, (11, 1))
    truth = true_terms()
    terms = tuple(
        CalibrationTerm(kind=kind, axis=i, value=float(truth[kind][i]), standard_error=0.0)
        for kind in ("gyro_bias", "gyro_scale")
        for i in range(3)
    )
    new = FILTERS["complementary"].calibrated(of, terms).design
    force = np.tile((0.0, 0.0, -1.0), (11, 1))
    angles = FILTERS["complementary"].run_float(new, reading, force)
    assert (angles[-1, 0] - angles[0, 0]) / 0.1 == pytest.approx(-0.3, abs=1e-4)
    assert (angles[-1, 1] - angles[0, 1]) / 0.1 == pytest.approx(-0.2, abs=1e-4)


def test_filters_of_sensor_axes_take_everything_and_others_nothing() -> None:
    found = take_sensor_terms(design(), TERMS)
    assert found.taken == tuple(term.name for term in TERMS)
    assert found.design.parameter("accel_offset_z_m_s2") == pytest.approx(0.23)
    assert found.design.parameter("gyro_bias_x_rad_s") == pytest.approx(0.01)
    names = [p.name for p in found.design.parameters]
    assert names == sorted(names)
    assert take_no_terms(design(), TERMS) == Calibrated(design=design(), taken=())


def test_a_design_remembers_its_calibration(folder: Path) -> None:
    assert run(["calibrate", "imu", "design.json", "many.npz", "-o", "out.json"]) == 0
    found = load_design(Path("out.json"))
    assert from_document(json.loads(design_text(found))) == found
    assert '"calibration"' not in design_text(design())
    document = json.loads(design_text(found))
    document["calibration"]["terms"]["gyro_bias_w"] = {}
    with pytest.raises(DesignError, match="unknown key 'gyro_bias_w'"):
        from_document(document)
    document = json.loads(design_text(found))
    document["calibration"]["terms"]["gyro_bias_x"]["unit"] = "deg/s"
    with pytest.raises(DesignError, match=r"unit is 'deg/s'; it must be one of rad/s"):
        from_document(document)
