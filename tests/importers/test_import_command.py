import io
import json
from pathlib import Path

import numpy as np
import pytest

from hostkit.cli.import_ import terminal_progress
from hostkit.cli.main import run
from hostkit.importers import IMPORTERS
from hostkit.recordings import Recording, load, save

Run = tuple[int, str, str]


@pytest.fixture
def hostkit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd):  # type: ignore[no-untyped-def]
    monkeypatch.chdir(tmp_path)

    def call(*arguments: str) -> Run:
        code = run(list(arguments))
        out, err = capfd.readouterr()
        return code, out, err

    return call


@pytest.fixture
def sketch(tmp_path: Path, truth: Recording, tilt_of) -> Path:
    """A log in deg/s, g and ms with a reference in degrees."""
    path = tmp_path / "sketch.txt"
    roll, pitch = np.degrees(tilt_of(truth))
    rows = np.column_stack(
        (
            np.round(truth.time_s * 1e3),
            truth.specific_force_m_s2 / 9.80665,
            np.degrees(truth.angular_rate_rad_s),
            roll,
            pitch,
        )
    )
    header = "time\tax\tay\taz\tgx\tgy\tgz\troll\tpitch"
    np.savetxt(path, rows, delimiter="\t", header=header, comments="", fmt="%.9g")
    return path


def test_import_then_tune(hostkit, sketch: Path, truth: Recording) -> None:
    save(truth, sketch.with_name("direct.npz"))
    assert hostkit("import", "sketch.txt", "-o", "got.npz")[0] == 0
    got = load(sketch.with_name("got.npz"))
    np.testing.assert_allclose(got.up_reference, truth.up_reference, atol=1e-7)
    results = []
    for name in ("got.npz", "direct.npz"):
        code, out, _ = hostkit("tune", name, "-o", "d.json", "--iterations", "20", "--json")
        assert code == 0
        results.append(json.loads(out))
    assert results[0]["eta"] == pytest.approx(results[1]["eta"], abs=1e-5)
    assert results[0]["rmse_deg"] == pytest.approx(results[1]["rmse_deg"], abs=1e-4)


def test_json_is_one_document(hostkit, sketch: Path) -> None:
    code, out, err = hostkit("import", "sketch.txt", "-o", "a.csv", "--no-reference", "--json")
    assert code == 0
    document = json.loads(out)
    assert list(document) == [
        "schema", "recording", "samples", "rate_hz", "warnings", "format", "guessed",
    ]  # fmt: skip
    assert document["schema"] == "hostkit.import/1"
    assert (document["recording"], document["format"]) == ("a.csv", "csv")
    assert (document["samples"], document["rate_hz"]) == (2000, 100.0)
    assert [w.partition(":")[0] for w in document["warnings"]] == ["reference"]
    assert len(document["guessed"]) == 3
    for sentence in document["guessed"] + document["warnings"]:
        assert sentence in err


def test_summary_on_stdout_and_card_on_stderr(hostkit, sketch: Path) -> None:
    code, out, err = hostkit("import", "sketch.txt", "-o", "a.npz", "--format", "csv")
    assert code == 0
    assert out == "a.npz: 2000 samples at 100 Hz, from csv\n"
    assert "sketch.txt: rate is in deg/s" in err
    assert "sketch.txt: sanity card\n  time: 2000 samples" in err
    assert "% read" not in err


def test_origin_names_the_source(hostkit, sketch: Path) -> None:
    hostkit("import", "sketch.txt", "-o", "a.npz")
    assert load(sketch.with_name("a.npz")).origin.startswith("imported from sketch.txt, sha256 ")


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (("nothing.csv", "-o", "a.csv"), 2, "does not exist"),
        (("sketch.txt", "-o", "a.txt"), 2, "must end in .csv or .npz"),
        (("sketch.txt", "-o", "a.csv", "--format", "xls"), 2, "xls"),
        (("sketch.txt", "-o", "a.csv", "--columns", "ax"), 2, "is not ROLE=COLUMN"),
        (("sketch.txt", "-o", "a.csv", "--rate-hz", "nan"), 2, "nan"),
        (("sketch.txt", "-o", "a.csv", "--topic", "/imu"), 1, "--topic says nothing about"),
        (("sketch.txt", "-o", "a.csv", "--format", "ulog"), 1, "it is damaged, or no ULog"),
        (("sketch.txt", "-o", "a.csv", "--time-unit", "ns"), 1, "1e+08 Hz"),
        (("sketch.txt", "-o", "a.csv", "--gyro-unit", "rad/s"), 1, "angular rate"),
        (("sketch.txt", "-o", "nowhere/a.csv"), 1, "cannot be written"),
    ],
)
def test_faults_are_one_line_and_write_nothing(
    hostkit, sketch: Path, arguments: tuple[str, ...], code: int, message: str
) -> None:
    got, out, err = hostkit("import", *arguments)
    assert (got, out) == (code, "")
    assert message in err.splitlines()[-1]
    assert sum(line.startswith("hostkit: ") for line in err.splitlines()) == (code == 1)
    assert {p.name for p in sketch.parent.iterdir()} == {"sketch.txt"}


def test_resample_and_decimate(hostkit, sketch: Path, truth: Recording) -> None:
    code, out, _ = hostkit(
        "import", "sketch.txt", "-o", "a.npz", "--resample", "100", "--decimate", "2"
    )
    assert (code, out) == (0, "a.npz: 1000 samples at 50 Hz, from csv\n")
    got = load(sketch.with_name("a.npz"))
    np.testing.assert_allclose(got.time_s, truth.time_s[1::2], atol=1e-6)
    np.testing.assert_allclose(got.up_reference, truth.up_reference[1::2], atol=1e-6)


def test_bursty_logs_are_told_what_to_do(hostkit, sketch: Path) -> None:
    text = sketch.read_text().splitlines()
    rows = [line.split("\t") for line in text[1:]]
    for n, row in enumerate(rows):
        row[0] = str(n // 10 * 100 + 2 * (n % 10))
    sketch.write_text("\n".join([text[0], *("\t".join(row) for row in rows)]))
    code, _, err = hostkit("import", "sketch.txt", "-o", "a.npz", "--gyro-unit", "deg/s")
    assert code == 0
    assert "the rate is 500 Hz by the median step and 100.4 Hz by the mean one" in err
    assert "jitter" in err or "gap" in err
    code, _, err = hostkit(
        "import", "sketch.txt", "-o", "a.npz", "--gyro-unit", "deg/s", "--resample", "100"
    )
    assert code == 0
    assert "bursts" not in err
    assert "gap" not in err


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_progress_on_a_terminal_once_a_second() -> None:
    now = iter(np.arange(100) / 4.0)
    shown = Terminal()
    progress = terminal_progress(shown, lambda: float(next(now)))
    for done in range(9):
        progress(done, 8)
    assert shown.getvalue().count("% read") == 2
    silent = io.StringIO()
    terminal_progress(silent, lambda: float(next(now)) * 100.0)(1, 2)
    assert silent.getvalue() == ""


def test_every_format_is_documented() -> None:
    page = (Path(__file__).resolve().parents[2] / "docs" / "importing.md").read_text()
    for importer in IMPORTERS:
        assert f"`{importer.name}`" in page
        for suffix in importer.suffixes:
            assert f"`{suffix}`" in page
