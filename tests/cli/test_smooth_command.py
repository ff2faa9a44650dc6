import json
from dataclasses import replace
from pathlib import Path

import pytest
from designs import design
from recorded import recorded

from hostkit.cli.main import run
from hostkit.design_file import save_design
from hostkit.recordings import load, save
from hostkit.simulation import SensorErrors


@pytest.fixture
def call(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    """Run one command line in a folder with two recordings, one of them without a reference."""
    monkeypatch.chdir(tmp_path)
    free = recorded("free", duration_s=8.0, errors=SensorErrors.none())
    save(free, Path("lab.npz"))
    save(replace(free, up_reference=None), Path("field.csv"))

    def called(*arguments: str) -> tuple[int, str, str]:
        code = run(["smooth", *arguments])
        said = capsys.readouterr()
        return code, said.out, said.err

    return called


def test_a_field_recording_gets_a_reference_that_tune_takes(call) -> None:
    code, out, _ = call("field.csv", "-o", "smoothed.csv")
    assert (code, "as its reference" in out) == (0, True)
    assert load(Path("smoothed.csv")).up_reference is not None
    assert run(["tune", "smoothed.csv", "--resamples", "0", "--no-held-out"]) == 0


def test_a_folder_takes_several_and_the_document_has_the_error(call) -> None:
    code, out, _ = call("lab.npz", "field.csv", "-o", "out", "--json", "--lead-ms", "1")
    document = json.loads(out)
    assert (code, document["schema"]) == (0, "hostkit.smooth/1")
    lab, field = document["recordings"]
    assert (lab["written_as"], field["written_as"]) == ("smooth", "reference")
    assert 0.0 < lab["rmse_deg"]["inclination"] < 1.0
    assert document["mean_rmse_deg"] == lab["rmse_deg"]["inclination"]
    assert field["rmse_deg"] is None
    assert lab["pieces"][0]["settings"]["lead_s"] == 0.001
    assert sorted(p.name for p in Path("out").iterdir()) == ["field.csv", "lab.npz"]


def test_a_design_gives_axes_and_ranges(call) -> None:
    save_design(design(axes="pitch", gyro_full_scale_deg_s=250), Path("d.json"))
    _, out, err = call("lab.npz", "-o", "s.npz", "--design", "d.json", "--json")
    rmse = json.loads(out)["recordings"][0]["rmse_deg"]
    assert rmse["roll"] is None
    assert rmse["inclination"] is None
    assert rmse["pitch"] > 0.0
    assert "compared" in err


@pytest.mark.parametrize(
    ("arguments", "code", "reason"),
    [
        (("lab.npz", "-o", "lab.npz"), 2, "overwrite"),
        (("lab.npz", "field.csv", "-o", "one.npz"), 2, "need a folder"),
        (("lab.npz", "-o", "one.txt"), 1, "recordings end in"),
        (("lab.npz", "-o", "x.csv", "--train"), 2, "must end in .json"),
        (("field.csv", "-o", "x.json", "--train"), 1, "no measured reference"),
        (("lab.npz", "-o", "x.json", "--train", "--report", "r.html"), 2, "--train writes"),
        (("lab.npz", "-o", "x.npz", "--lead-ms", "nan"), 2, "finite"),
        (("lab.npz", "-o", "x.npz", "--settings", "field.csv"), 1, "not strict JSON"),
    ],
)
def test_wrong_use_is_told(call, arguments: tuple[str, ...], code: int, reason: str) -> None:
    found, _, err = call(*arguments)
    assert (found, reason in err) == (code, True), err


def test_trained_settings_are_written_and_used(call) -> None:
    code, out, _ = call("lab.npz", "--train", "--evaluations", "40", "-o", "s.json", "--json")
    document = json.loads(out)
    assert (code, document["schema"]) == (0, "hostkit.smooth.train/1")
    assert document["held_out_rmse_deg"] is None
    assert json.loads(Path("s.json").read_text())["training"]["recordings"][0]["sha256"]
    _, out, _ = call("lab.npz", "--settings", "s.json", "-o", "s.npz", "--json")
    (piece,) = json.loads(out)["recordings"][0]["pieces"]
    assert piece["compared"] == 0
    assert piece["settings"] == document["settings"]


def test_the_report_stands_alone(call) -> None:
    pytest.importorskip("matplotlib")
    code, _, _ = call("lab.npz", "field.csv", "-o", "out", "--report", "r.html")
    text = Path("r.html").read_text()
    assert code == 0
    assert "inclination error" in text
    assert "<script" not in text
