import json
import re
from pathlib import Path

import pytest
from flights import flight

from hostkit.cli import compare as compare_module
from hostkit.cli.main import run
from hostkit.comparison import Cost
from hostkit.recordings import save

COSTS = (Cost(name="vqf-online", title="VQF", timed="C++", ns_per_sample=250.0),)
QUICK = ("--iterations", "2", "--particles", "4", "--resamples", "0", "--no-held-out")
DOCS = Path(__file__).resolve().parents[2] / "docs"


@pytest.fixture
def recording(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    save(flight(), Path("flight.npz"))
    return "flight.npz"


def keys_of(value):
    if isinstance(value, list):
        return {key for item in value for key in keys_of(item)}
    if not isinstance(value, dict):
        return set()
    return set(value) | {key for item in value.values() for key in keys_of(item)}


def test_document_is_the_documented_schema(recording, capsys, monkeypatch):
    options = ["--evaluations", "40", "--peers", "none", "--json"]
    monkeypatch.setattr(compare_module, "costs", lambda recording, options: COSTS)
    assert run(["compare", recording, *options]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["schema"] == "hostkit.compare/1"
    text = (DOCS / "compare.md").read_text(encoding="utf-8")
    for key in keys_of(document):
        assert f"`{key}`" in text, key
    tuned = [f for f in document["filters"] if f["settings"] == "tuned"]
    assert [f["name"] for f in tuned] == ["complementary", "observer"]
    assert tuned[1]["held_out"]["rmse_deg"] < tuned[0]["held_out"]["rmse_deg"]


def test_a_design_is_compared_as_it_is(recording, capsys, monkeypatch):
    assert run(["tune", recording, "--filter", "observer", "-o", "own.json", *QUICK]) == 0
    design = ["compare", recording, "--design", "own.json", "--peers", "none", "--no-tune"]
    assert run([*design, "--axes", "roll", "--no-cost"]) == 2
    assert "--axes roll: the design has both" in capsys.readouterr().err
    both = tuple(
        Cost(name="observer", title="observer", timed="C", arithmetic=arithmetic, ns_per_sample=ns)
        for arithmetic, ns in (("float", 35.0), ("fixed", 67.0))
    )
    monkeypatch.setattr(compare_module, "costs", lambda recording, options: both)
    assert run(design) == 0
    row = next(x for x in capsys.readouterr().out.splitlines() if " design " in x)
    assert row.split()[-1] == "67"


def test_table_and_report(recording, capsys):
    pytest.importorskip("vqf")
    pytest.importorskip("matplotlib")
    options = [
        "--no-tune",
        "--peers",
        "vqf-online,vqf-offline",
        "--report",
        "report.html",
        "--no-cost",
    ]
    assert run(["compare", recording, *options, "--lead-ms", "2"]) == 0
    out = capsys.readouterr().out
    assert "told 2 ms ahead" in out
    for name in ("complementary filter", "bounded-velocity observer", "hostkit smooth", "VQF"):
        assert re.search(rf"^{name}\s+default\s", out, re.MULTILINE), name
    assert "cannot be told so far ahead: complementary filter" in out
    page = Path("report.html").read_text(encoding="utf-8")
    assert "<svg" in page


def test_design_is_compared_and_known_to_be_trained_here(recording, capsys):
    tuning = ["--filter", "observer", "--iterations", "2", "--resamples", "0"]
    assert run(["tune", recording, *tuning]) == 0
    capsys.readouterr()
    options = ["--design", "design.json", "--peers", "none", "--no-cost"]
    assert run(["compare", recording, *options]) == 0
    out = capsys.readouterr().out
    assert "the design was tuned on 1 of these recordings" in out
    assert "complementary" not in out


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--peers", "kalman"], "no peer 'kalman'"),
        (["--calibrated-peers"], "name the design"),
        (["--lead-ms", "99"], "outside"),
        (["--lead-ms", "nan"], "finite"),
    ],
)
def test_wrong_use(recording, capsys, options, words):
    assert run(["compare", recording, *options]) == 2
    assert words in capsys.readouterr().err
