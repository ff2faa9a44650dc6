import json
from pathlib import Path

import pytest
from recorded import recorded

from hostkit.cli.main import run
from hostkit.design_file import load_design
from hostkit.mounting import Mounting
from hostkit.recordings import save
from hostkit.units import RAD_PER_DEG


@pytest.fixture
def tune(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    """Tune on three recordings; gives what was said on either stream."""
    monkeypatch.chdir(tmp_path)
    names = []
    for seed, profile in enumerate(("steps", "random", "sine-sweep")):
        names.append(f"{profile}.npz")
        save(recorded(profile, seed=seed), Path(names[-1]))

    def call(*options: str) -> tuple[str, str]:
        assert run(["tune", *names, *options]) == 0
        said = capsys.readouterr()
        return said.out, said.err

    return call


def test_held_out_stands_beside_training(tune):
    out, err = tune("--axes", "roll")
    line = next(line for line in out.splitlines() if line.startswith("RMSE of roll"))
    assert "deg on the 3 training recordings" in line
    assert "deg on recordings left out (3 folds)" in line
    assert "motion of 3 recording(s): " in err
    assert "left out" not in tune("--axes", "roll", "--no-held-out")[0]


def test_a_recording_that_is_named_twice_is_said(tune):
    assert "same recording" not in tune("--axes", "roll", "--resamples", "0")[1]
    err = tune("steps.npz", "--axes", "roll", "--resamples", "0")[1]
    assert "steps is the same recording as steps" in err


def test_document_has_held_out_intervals_and_history(tune):
    document = json.loads(tune("--axes", "roll", "--json", "--resamples", "10")[0])
    held_out = document["held_out"]
    assert (held_out["unit"], held_out["folds"], len(held_out["each_rmse_deg"])) == (
        "recordings",
        3,
        3,
    )
    assert held_out["rmse_deg"] == pytest.approx(sum(held_out["each_rmse_deg"]) / 3)
    (interval,) = document["intervals"]
    assert interval["low"] <= interval["value"] <= interval["high"]
    assert interval["value"] == pytest.approx(document["tau_s"])
    assert document["history_rad"][-1] == min(document["history_rad"])
    assert document["optimiser"] == "grid-brent"
    assert load_design(Path("design.json")).tuning.held_out_rmse_deg == pytest.approx(
        held_out["rmse_deg"], abs=1e-6
    )


def test_a_swarm_for_one_parameter_is_obeyed_and_remarked_on(tune):
    _, err = tune("--axes", "roll", "--optimiser", "qpso")
    assert "one parameter needs no swarm" in err
    assert "one parameter needs no swarm" not in tune("--axes", "roll")[1]


def test_names_units_and_axes_of_parameters(tune):
    quick = ("--iterations", "3", "--particles", "4", "--resamples", "0", "--no-held-out")
    tune(
        *("--free", "tau,gate", "--fix", "gyro-bias-pitch=0.4", "--fix", "tilt-offset=-1"),
        *("--range", "gate=0.05:0.1", *quick),
    )
    design = load_design(Path("design.json"))
    values = {p.name: p.value for p in design.parameters}
    assert set(values) == {
        "eta",
        "gate_g",
        "gyro_bias_pitch_rad_s",
        "tilt_offset_pitch_rad",
        "tilt_offset_roll_rad",
    }
    assert values["gyro_bias_pitch_rad_s"] == pytest.approx(0.4 * RAD_PER_DEG)
    assert values["tilt_offset_roll_rad"] == pytest.approx(-1.0 * RAD_PER_DEG)
    assert 0.05 <= values["gate_g"] <= 0.1
    out, _ = tune("--free", "all", "--axes", "pitch", "--fix", "gate=0.2", *quick)
    assert "gyro-bias of pitch: " in out
    assert "gate" not in out


def test_report_shows_every_part(tune):
    options = ("--free", "tau,gyro-scale", "--axes", "roll", "--iterations", "30")
    tune(*options, "--resamples", "10", "--report", "tune.html")
    page = Path("tune.html").read_text(encoding="utf-8")
    for part in (
        "Convergence",
        "Cost along each parameter",
        "gyro-scale of roll",
        "Fit",
        "Residuals",
        "Frequency response",
        "RMSE of roll, held out",
        "rms left out, deg",
        "97.5 %",
        "seed",
        "numpy version",
        "sha256",
    ):
        assert part in page, part
    assert page.count("<svg") == 5
    assert "<script" not in page


def test_precision_and_threads_change_digits_only(tune):
    plain = json.loads(tune("--axes", "roll", "--json")[0])
    narrow = json.loads(tune("--axes", "roll", "--json", "--precision", "float32")[0])
    threads = json.loads(tune("--axes", "roll", "--json", "--jobs", "3")[0])
    assert threads == plain
    assert narrow["tau_s"] == pytest.approx(plain["tau_s"], rel=1e-2)
    assert narrow["rmse_deg"] == pytest.approx(plain["rmse_deg"], rel=1e-3)


def test_motion_that_no_eta_mends_is_said_before_tuning(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    save(recorded("free", duration_s=20.0), Path("free.npz"))
    assert run(["tune", "free.npz"]) == 0
    err = capsys.readouterr().err
    assert "needs a three-dimensional filter (1)" in err
    assert Mounting.parse("+x+y+z") == load_design(Path("design.json")).mounting


def test_recordings_or_a_fleet_but_not_both(tune, capsys):
    assert run(["tune"]) == 2
    assert "name recordings, or a folder of devices" in capsys.readouterr().err
    Path("fleet").mkdir()
    assert run(["tune", "steps.npz", "--fleet", "fleet"]) == 2
