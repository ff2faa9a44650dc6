"""What `hostkit tune` says of input that cannot be tuned on: one line, and no file left behind."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from recorded import problem, recorded

from hostkit.cli.main import run
from hostkit.errors import HostkitError
from hostkit.optimisers import OPTIMISERS
from hostkit.recordings import save
from hostkit.tuning import TuningOptions
from hostkit.tuning.search import search

HEADER = (
    "time_s,gyro_x_rad_s,gyro_y_rad_s,gyro_z_rad_s,accel_x_m_s2,accel_y_m_s2,accel_z_m_s2,"
    "ref_roll_rad,ref_pitch_rad\n"
)


@pytest.fixture
def refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    """Tune on a file that must be refused, and return the last line that was said."""

    def tune(path: Path, *options: str, code: int = 1) -> str:
        output = tmp_path / "design.json"
        assert run(["tune", str(path), "-o", str(output), *options]) == code
        said = capsys.readouterr().err
        assert "Traceback" not in said
        assert "Warning" not in said
        assert not list(tmp_path.glob("*design*"))
        return said.strip().splitlines()[-1]

    return tune


def stored(tmp_path: Path, recording) -> Path:
    path = tmp_path / "rec.npz"
    save(recording, path)
    return path


def written(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "rec.csv"
    path.write_text(text, encoding="ascii")
    return path


def test_empty_recordings_and_single_samples(tmp_path, refused):
    assert "rec.csv" in refused(written(tmp_path, ""))
    assert "0 sample(s); a recording needs at least 2" in refused(written(tmp_path, HEADER))
    one = HEADER + "0,0,0,0,0,0,9.81,0,0\n"
    assert "1 sample(s); a recording needs at least 2" in refused(written(tmp_path, one))


def test_no_sample_that_counts(tmp_path, refused):
    recording = recorded()
    none = replace(recording, valid=np.zeros(len(recording), dtype=bool))
    assert "none of its 1000 samples is valid" in refused(stored(tmp_path, none))
    lost = replace(recording, up_reference=None)
    assert "rec has no reference: add ref_roll_rad" in refused(stored(tmp_path, lost))


def test_two_samples_are_tuned_or_refused_in_one_line(tmp_path, capsys):
    rows = "0,0,0,0,0,0,9.81,0,0\n0.01,0,0,0,0,0,9.81,0,0\n"
    path = written(tmp_path, HEADER + rows)
    assert run(["tune", str(path), "-o", str(tmp_path / "d.json")]) in (0, 1)
    said = capsys.readouterr().err
    assert "Traceback" not in said
    assert "Warning" not in said


def test_constant_signals_say_that_they_determine_nothing(tmp_path, capsys):
    rows = "".join(f"{k / 100},0,0,0,0,0,9.81,0.02,0\n" for k in range(500))
    path = written(tmp_path, HEADER + rows)
    assert run(["tune", str(path), "--axes", "roll", "-o", str(tmp_path / "d.json")]) == 0
    said = capsys.readouterr().err
    assert "the recordings do not determine tau" in said
    assert "Warning" not in said


def test_bounds_reversed_and_unknown_names_are_wrong_use(tmp_path, refused):
    path = stored(tmp_path, recorded())
    assert "must be below the upper one" in refused(path, "--range", "tau=5:1", code=2)
    assert "must be below the upper one" in refused(path, "--range", "tau=0:1", code=2)
    assert "'inf' is not a finite number" in refused(path, "--range", "tau=1:inf", code=2)
    assert "no parameter of the complementary filter; known are: tau" in refused(
        path, "--free", "tau,magic", code=2
    )
    assert "gate is one for all axes" in refused(path, "--fix", "gate-roll=0.1", code=2)
    assert "gyro-bias = 30 deg/s" in refused(path, "--fix", "gyro-bias=30")
    assert "grid-brent takes one parameter, 2 are free" in refused(
        path, "--free", "tau,gate", "--optimiser", "grid-brent"
    )


def test_different_rates_are_refused(tmp_path, refused):
    recording = recorded()
    slow = tmp_path / "slow.npz"
    half = replace(recording, time_s=recording.time_s * 2.0, rate_hz=50.0)
    save(replace(half, angular_rate_rad_s=recording.angular_rate_rad_s / 2.0), slow)
    assert "50 Hz" in refused(stored(tmp_path, recording), str(slow))


def test_a_cost_that_is_never_finite_is_an_error():
    recording = recorded()
    force = np.array(recording.specific_force_m_s2)
    force[0] = np.nan
    p = problem(replace(recording, specific_force_m_s2=force))
    for optimiser in ("grid-brent", "qpso", "pso"):
        with pytest.raises(HostkitError, match="finite"):
            search(p, TuningOptions(optimiser=optimiser), optimiser)


def test_a_cost_that_is_sometimes_not_finite_is_lived_with():
    p = problem(recorded())

    def holed(points):
        cost = p.cost(points)
        return np.where(points[:, 0] > 0.0, np.nan, cost)

    for name in ("grid-brent", "qpso", "awp", "differential-evolution"):
        result = OPTIMISERS[name].minimise(
            holed, p.space.lower, p.space.upper, rng=np.random.default_rng(1)
        )
        assert np.isfinite(result.cost)
        assert result.x[0] <= 0.0


def test_nothing_is_written_where_the_folder_is_missing(tmp_path, capsys):
    path = stored(tmp_path, recorded(duration_s=3.0))
    assert run(["tune", str(path), "-o", str(tmp_path / "no" / "d.json")]) == 1
    assert "cannot be written" in capsys.readouterr().err
