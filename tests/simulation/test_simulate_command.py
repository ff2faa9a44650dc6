import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

from hostkit.cli.simulate import simulate
from hostkit.errors import HostkitError
from hostkit.recordings import load
from hostkit.units import DEG_PER_RAD


def invoke(*arguments: str) -> Result:
    return CliRunner().invoke(simulate, arguments)


def test_json_is_one_document(tmp_path: Path) -> None:
    path = str(tmp_path / "a.csv")
    result = invoke("-o", path, "--duration", "5", "--rate", "125", "--seed", "9", "--json")
    assert result.exit_code == 0
    assert json.loads(result.stdout) == {
        "schema": "hostkit.simulate/1",
        "recording": path,
        "samples": 625,
        "rate_hz": 125.0,
        "seed": 9,
    }
    assert len(load(Path(path))) == 625


def test_summary_is_one_line_and_the_card_goes_to_stderr(tmp_path: Path) -> None:
    path = str(tmp_path / "a.npz")
    result = invoke("-o", path, "--duration", "5")
    assert result.stdout == f"{path}: 500 samples at 100 Hz, profile free, seed 1\n"
    assert result.stderr.startswith("time: 500 samples at 100 Hz")
    assert result.stderr.endswith("no warnings\n")


def test_defaults(tmp_path: Path) -> None:
    assert invoke("-o", str(tmp_path / "a.npz")).exit_code == 0
    recording = load(tmp_path / "a.npz")
    assert (len(recording), recording.rate_hz) == (6000, 100.0)
    assert recording.up_reference is not None


def test_same_seed_same_file(tmp_path: Path) -> None:
    for name, seed in (("a", "1"), ("b", "1"), ("c", "2")):
        invoke("-o", str(tmp_path / f"{name}.npz"), "--duration", "5", "--seed", seed)
    a, b, c = ((tmp_path / f"{name}.npz").read_bytes() for name in "abc")
    assert a == b != c


def test_bias_vibration_and_ideal(tmp_path: Path) -> None:
    path = tmp_path / "a.npz"
    rest = ("-o", str(path), "--profile", "rest", "--duration", "20")
    invoke(*rest, "--gyro-bias", "-2.5")
    mean = load(path).angular_rate_rad_s.mean(axis=0) * DEG_PER_RAD
    np.testing.assert_allclose(mean, -2.5, atol=0.1)
    invoke(*rest, "--vibration", "3", "--low-pass", "0")
    assert load(path).specific_force_m_s2.std() > 2.5
    invoke(*rest, "--ideal")
    assert not load(path).angular_rate_rad_s.any()


def test_clipping_is_told(tmp_path: Path) -> None:
    result = invoke("-o", str(tmp_path / "a.npz"), "--gyro-range", "250", "--gyro-bias", "20")
    assert "clipping: gyro" in result.stderr


@pytest.mark.parametrize(
    ("arguments", "limit"),
    [
        ((), "Missing option '-o'"),
        (("-o", "a.txt"), "a.txt must end in .csv or .npz"),
        (("-o", "a.csv", "--profile", "loop"), "'rest', 'sine-sweep', 'steps', 'random', 'free'"),
        (("-o", "a.csv", "--duration", "0"), "x>0"),
        (("-o", "a.csv", "--duration", "nan"), "nan is not a finite number"),
        (("-o", "a.csv", "--duration", "0.001"), "outside [0.02, "),
        (("-o", "a.csv", "--rate", "30"), "nearest is 30.303 Hz"),
        (("-o", "a.csv", "--rate", "2000"), "0.0<x<=1000.0"),
        (("-o", "a.csv", "--seed", "-1"), "0<=x<="),
        (("-o", "a.csv", "--gyro-range", "300"), "'250', '500', '1000', '2000'"),
        (("-o", "a.csv", "--accel-range", "3"), "'2', '4', '8', '16'"),
        (("-o", "a.csv", "--low-pass", "7"), "'0', '1', '2', '3', '4', '5', '6'"),
        (("-o", "a.csv", "--gyro-bias", "21"), "-20.0<=x<=20.0"),
        (("-o", "a.csv", "--vibration", "-1"), "0.0<=x<=10.0"),
        (("-o", "a.csv", "--ideal", "--vibration", "1"), "--ideal has no error"),
    ],
)
def test_wrong_use_exits_with_2_and_names_the_limit(
    arguments: tuple[str, ...], limit: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    result = invoke(*arguments)
    assert result.exit_code == 2
    assert limit in " ".join(result.stderr.split())
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_is_not_there_is_a_hostkit_error(tmp_path: Path) -> None:
    result = invoke("-o", str(tmp_path / "none" / "a.csv"), "--duration", "1")
    assert isinstance(result.exception, HostkitError)


def test_help_shows_an_example_that_works(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (line,) = [
        text for text in invoke("--help").stdout.splitlines() if "hostkit simulate -" in text
    ]
    assert invoke(*line.split()[2:]).exit_code == 0
    assert (tmp_path / "flight.csv").exists()
