"""The subcommand, its documents, its report, and the way back into the simulation."""

import json
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner, Result
from diagnosis_cases import Simulate

from hostkit.cli.diagnose import diagnose
from hostkit.cli.simulate import simulate
from hostkit.diagnosis import load_measured_errors
from hostkit.errors import HostkitError, ToolMissingError
from hostkit.recordings import load, save
from hostkit.simulation import SensorErrors
from hostkit.units import DEG_PER_RAD, RAD_PER_DEG

GYRO_DEG_S_RTHZ = (0.004, 0.006, 0.009)
ACCEL_M_S2_RTHZ = (0.003, 0.004, 0.006)
BIAS_DEG_S = (1.5, -0.4, 0.2)


def run(*arguments: str | Path) -> Result:
    return CliRunner().invoke(diagnose, [str(a) for a in arguments])


@pytest.fixture(scope="module")
def resting(tmp_path_factory: pytest.TempPathFactory, moved: Simulate) -> Path:
    """Two hundred seconds at rest of a sensor whose noise differs from axis to axis."""
    x, y, z = (v * RAD_PER_DEG for v in GYRO_DEG_S_RTHZ)
    bx, by, bz = (v * RAD_PER_DEG for v in BIAS_DEG_S)
    errors = replace(
        SensorErrors(),
        gyro_bias_rad_s=(bx, by, bz),
        gyro_bias_walk_rad_s_rts=0.0,
        gyro_noise_density_rad_s_rthz=(x, y, z),
        accel_noise_density_m_s2_rthz=ACCEL_M_S2_RTHZ,
    )
    path = tmp_path_factory.mktemp("resting") / "rest.npz"
    save(moved("rest", 200.0, errors), path)
    return path


@pytest.fixture(scope="module")
def allan_file(resting: Path) -> Path:
    path = resting.with_name("allan.json")
    assert run(resting, "--allan-out", path).exit_code == 0
    return path


@pytest.fixture
def swing(tmp_path: Path, moved: Simulate) -> Path:
    path = tmp_path / "swing.npz"
    save(moved("planar", 20.0), path)
    return path


def noise_in(path: Path) -> Any:
    return json.loads(path.read_text())["recordings"][0]["noise"]


def test_card_has_a_line_for_each_topic(swing: Path) -> None:
    result = run(swing, "--axes", "roll")
    assert result.exit_code == 0
    head, *lines = result.stdout.splitlines()
    assert head == f"{swing}: 2000 samples at 100 Hz, 19.99 s; axes roll, mounting +x+y+z"
    topics = [line[2:].split()[0] for line in lines]
    assert topics == ["time", "range", "rest", "vibration", "force", "motion", "noise"]
    marks = {topic: line[0] for topic, line in zip(topics, lines, strict=True)}
    assert marks["rest"] == marks["force"] == "!"
    assert marks["motion"] == marks["time"] == " "
    assert "planar: a roll filter with tau" in result.stdout


def test_turning_about_another_axis_names_the_mounting(swing: Path) -> None:
    result = run(swing, "--axes", "pitch", "--mounting", "+z+x+y")
    assert "needs a three-dimensional filter" in result.stdout
    assert "try --axes roll --mounting +x+y+z" in result.stdout


def test_json_is_the_documented_schema(swing: Path, resting: Path) -> None:
    result = run(swing, resting, "--axes", "roll", "--json")
    document = json.loads(result.stdout)
    assert document["schema"] == "hostkit.diagnose/1"
    page = Path(__file__).resolve().parents[2] / "docs" / "diagnosis.md"
    text = page.read_text(encoding="utf-8")
    for entry in document["recordings"]:
        for key in keys_of(entry):
            assert f"`{key}`" in text, key
    moving, still = document["recordings"]
    assert moving["noise"] is None
    assert moving["rest"]["bias_deg_s"] is None
    assert moving["motion"]["verdict"] == "planar"
    assert still["motion"]["verdict"] is None
    assert still["rest"]["share"] == 1.0
    assert still["rest"]["bias_deg_s"] == pytest.approx(BIAS_DEG_S, abs=0.01)
    assert sum(moving["time"]["histogram"]["counts"]) == 1999
    assert moving["force"]["deviation_percentiles_g"].keys() == {"50", "75", "90", "95", "99"}


def keys_of(value: object) -> set[str]:
    """Every key in a document, but the percentiles, which are numbers."""
    if isinstance(value, list):
        return {key for item in value for key in keys_of(item)}
    if not isinstance(value, dict):
        return set()
    named = {key for key in value if not key.isdigit()}
    return named | {key for item in value.values() for key in keys_of(item)}


def test_there_and_back_again(resting: Path, allan_file: Path, tmp_path: Path) -> None:
    """Simulate, diagnose, simulate with what was found, diagnose: the same sensor twice."""
    first = noise_in(allan_file)
    assert first["gyro"]["noise_density_deg_s_rthz"] == pytest.approx(GYRO_DEG_S_RTHZ, rel=0.06)
    assert first["accel"]["noise_density_m_s2_rthz"] == pytest.approx(ACCEL_M_S2_RTHZ, rel=0.06)
    again, second_file = tmp_path / "again.npz", tmp_path / "second.json"
    made = CliRunner().invoke(
        simulate,
        [
            *("-o", str(again), "--profile", "rest", "--duration", "200", "--seed", "9"),
            *("--errors-from", str(allan_file), "--low-pass", "1"),
        ],
    )
    assert made.exit_code == 0
    assert "no walk of the gyroscope bias was seen on x, y, z: none is simulated" in made.stderr
    assert run(again, "--allan-out", second_file).exit_code == 0
    second = noise_in(second_file)
    for element, key in (
        ("gyro", "noise_density_deg_s_rthz"),
        ("accel", "noise_density_m_s2_rthz"),
    ):
        assert second[element][key] == pytest.approx(first[element][key], rel=0.07)
    assert second["gyro"]["bias_deg_s"] == pytest.approx(first["gyro"]["bias_deg_s"], abs=0.01)
    assert not np.array_equal(load(again).angular_rate_rad_s, load(resting).angular_rate_rad_s)


def test_measured_walk_is_simulated(allan_file: Path, tmp_path: Path) -> None:
    document = json.loads(allan_file.read_text())
    document["recordings"][0]["noise"]["gyro"]["bias_walk_deg_s_rts"] = [0.01, None, 0.02]
    path = tmp_path / "walk.json"
    path.write_text(json.dumps(document))
    measured = load_measured_errors(path)
    walk = np.array(measured.errors.gyro_bias_walk_rad_s_rts) * DEG_PER_RAD
    np.testing.assert_allclose(walk, (0.01, 0.0, 0.02))
    assert measured.remarks == ("no walk of the gyroscope bias was seen on y: none is simulated",)


def test_the_whole_document_is_read_too(resting: Path, allan_file: Path, tmp_path: Path) -> None:
    path = tmp_path / "diagnosis.json"
    path.write_text(run(resting, "--json").stdout)
    assert load_measured_errors(path).errors == load_measured_errors(allan_file).errors


def test_densities_that_were_not_seen_are_filled_in(allan_file: Path, tmp_path: Path) -> None:
    document = json.loads(allan_file.read_text())
    noise = document["recordings"][0]["noise"]
    noise["gyro"]["noise_density_deg_s_rthz"] = [0.01, None, 0.02]
    noise["accel"]["noise_density_m_s2_rthz"] = [None] * 3
    path = tmp_path / "holes.json"
    path.write_text(json.dumps(document))
    measured = load_measured_errors(path)
    density = np.array(measured.errors.gyro_noise_density_rad_s_rthz) * DEG_PER_RAD
    np.testing.assert_allclose(density, (0.01, 0.02, 0.02))
    assert measured.errors.accel_noise_density_m_s2_rthz is None
    assert "gyroscope y was seen: the largest of the other axes" in measured.remarks[0]
    assert "accelerometer was seen: the data sheet's" in measured.remarks[1]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[1", "it is not JSON"),
        ("[]", "lacks the key 'schema'"),
        ('{"schema": "hostkit.tune/1"}', "it must be hostkit.diagnose/1 or hostkit.allan/1"),
        ('{"schema": "hostkit.allan/1", "recordings": 3}', "it must be a list"),
        ('{"schema": "hostkit.allan/1", "recordings": []}', "0 of its 0 recording"),
        ('{"schema": "hostkit.allan/1", "recordings": [{"noise": null}]}', "0 of its 1 recording"),
        (
            '{"schema": "hostkit.allan/1", "recordings": [{"noise": {}, "name": "a"}]}',
            "noise lacks the key 'gyro'",
        ),
    ],
)
def test_what_is_no_diagnosis_is_refused(text: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    path.write_text(text)
    with pytest.raises(HostkitError, match=r"a\.json") as caught:
        load_measured_errors(path)
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("bias_deg_s", [1.0, None, 2.0], "it must be three numbers"),
        ("bias_deg_s", [1.0, 2.0], "must be a list of three"),
        ("bias_deg_s", [1.0, 2.0, "3"], "must be a finite number or null"),
        ("bias_deg_s", [1.0, 2.0, True], "must be a finite number or null"),
        ("bias_deg_s", [1.0, 2.0, float("nan")], "must be a finite number or null"),
        ("bias_deg_s", [1.0, 2.0, 1e9], "the limits are -1e+06 and 1e+06"),
        ("noise_density_deg_s_rthz", [1.0, 2.0, -1.0], "the limits are 0 and 1e+06"),
        ("bias_walk_deg_s_rts", [1.0, 2.0, -1.0], "the limits are 0 and 1e+06"),
    ],
)
def test_wrong_values_are_refused(
    allan_file: Path, tmp_path: Path, key: str, value: object, message: str
) -> None:
    document = json.loads(allan_file.read_text())
    document["recordings"][0]["noise"]["gyro"][key] = value
    path = tmp_path / "wrong.json"
    path.write_text(json.dumps(document))
    with pytest.raises(HostkitError) as caught:
        load_measured_errors(path)
    assert key in str(caught.value)
    assert message in str(caught.value)


def test_two_recordings_with_noise_are_one_too_many(resting: Path, tmp_path: Path) -> None:
    path = tmp_path / "two.json"
    assert run(resting, resting, "--allan-out", path).exit_code == 0
    with pytest.raises(HostkitError, match="2 of its 2"):
        load_measured_errors(path)


def test_ideal_has_no_measured_errors(allan_file: Path, tmp_path: Path) -> None:
    path = str(tmp_path / "a.npz")
    result = CliRunner().invoke(simulate, ["-o", path, "--ideal", "--errors-from", str(allan_file)])
    assert result.exit_code == 2
    assert "leave out --gyro-bias, --vibration and --errors-from" in " ".join(result.stderr.split())


def test_no_rest_leaves_a_remark(swing: Path, tmp_path: Path) -> None:
    path = tmp_path / "allan.json"
    result = run(swing, "--allan-out", path)
    assert result.exit_code == 0
    assert "no noise figures of" in result.stderr
    assert noise_in(path) is None


def test_without_allantools(resting: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Needed only where its result was asked for."""
    monkeypatch.setitem(sys.modules, "allantools", None)
    result = run(resting)
    assert result.exit_code == 0
    assert "left out: the Allan deviation needs allantools" in result.stderr
    path = tmp_path / "allan.json"
    assert isinstance(run(resting, "--allan-out", path).exception, ToolMissingError)
    assert not path.exists()


def test_report_has_all_figures_and_is_repeatable(
    resting: Path, swing: Path, tmp_path: Path
) -> None:
    reports = []
    for name in ("a.html", "b.html"):
        assert run(resting, swing, "--report", tmp_path / name).exit_code == 0
        reports.append((tmp_path / name).read_text(encoding="utf-8"))
    assert reports[0] == reports[1]
    for title in ("findings", "time steps", "rest", "spectrum", "distance to 1 g"):
        assert f"<h2>rest: {title}</h2>" in reports[0]
        assert f"<h2>swing: {title}</h2>" in reports[0]
    assert "<h2>rest: Allan deviation</h2>" in reports[0]
    assert "<h2>swing: Allan deviation</h2>" not in reports[0]
    assert reports[0].count("<svg") == 9


def test_report_of_signals_without_noise(tmp_path: Path, moved: Simulate) -> None:
    path = tmp_path / "ideal.npz"
    save(moved("rest", 40.0, SensorErrors.none()), path)
    assert run(path, "--report", tmp_path / "a.html").exit_code == 0


def test_a_folder_that_is_not_there_is_a_hostkit_error(swing: Path, tmp_path: Path) -> None:
    for option in ("--report", "--allan-out"):
        result = run(swing, option, tmp_path / "none" / "a")
        assert isinstance(result.exception, HostkitError)


@pytest.mark.parametrize(
    ("arguments", "limit"),
    [
        (("--axes", "yaw"), "'roll', 'pitch', 'both'"),
        (("--mounting", "+x+y"), "is not three signed sensor axes"),
    ],
)
def test_wrong_use_exits_with_2(swing: Path, arguments: tuple[str, ...], limit: str) -> None:
    result = run(swing, *arguments)
    assert result.exit_code == 2
    assert limit in " ".join(result.stderr.split())
