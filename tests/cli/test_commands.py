import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from hostkit.cli.main import COMMANDS, run


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def hostkit(here: Path, capfd: pytest.CaptureFixture[str]):
    """Run one command line; gives exit code, standard output, standard error."""

    def call(*arguments: str) -> tuple[int, str, str]:
        code = run(list(arguments))
        out, err = capfd.readouterr()
        return code, out, err

    return call


@pytest.fixture
def recording(hostkit, here: Path) -> str:
    assert (
        hostkit(
            "simulate", "--profile", "steps", "--vibration", "2", "--duration", "8", "-o", "r.csv"
        )[0]
        == 0
    )
    return "r.csv"


@pytest.fixture
def design(hostkit, recording: str) -> str:
    assert hostkit("tune", recording, "-o", "d.json", "--iterations", "20")[0] == 0
    return "d.json"


@pytest.mark.parametrize("name", COMMANDS)
def test_help_shows_an_example(hostkit, name: str) -> None:
    code, out, _ = hostkit(name, "--help")
    assert code == 0
    assert f"hostkit {name}" in out.split("Example:")[1]


def test_tune_tells_eta_tau_crossover_and_rate_together(hostkit, recording: str) -> None:
    _, out, _ = hostkit("tune", recording)
    first = out.splitlines()[0]
    assert all(word in first for word in ("eta", "tau", "crossover", "100 Hz"))


def test_tune_json_is_one_document_with_the_contracts_keys(hostkit, recording: str) -> None:
    code, out, _ = hostkit(
        *("tune", recording, "-o", "d.json", "--seed", "7", "--json", "--optimiser", "qpso")
    )
    document = json.loads(out)
    assert code == 0
    wanted = "schema design digest filter parameters eta tau_s rate_hz rmse_deg evaluations "
    wanted += "optimiser seed"
    assert set(wanted.split()) <= set(document)
    assert (document["schema"], document["seed"], document["evaluations"]) == (
        "hostkit.tune/1",
        7,
        2020,
    )
    assert json.loads(Path("d.json").read_text())["digest"] == document["digest"]


def test_same_seed_gives_the_same_file(hostkit, recording: str) -> None:
    for name in ("a.json", "b.json"):
        hostkit("tune", recording, "-o", name, "--seed", "3", "--iterations", "10")
    assert Path("a.json").read_bytes() == Path("b.json").read_bytes()


def test_evaluate_json(hostkit, recording: str, design: str) -> None:
    code, out, _ = hostkit("evaluate", design, recording, recording, "--json")
    document = json.loads(out)
    assert (code, len(document["recordings"])) == (0, 2)
    entry = document["recordings"][0]
    assert entry["path"] == recording
    assert set(entry["rmse_deg"]) == set(entry["max_deg"]) == {"roll", "pitch", "inclination"}
    assert 0 < entry["integer_vs_float_max_deg"] < 0.005
    tuned = json.loads(Path(design).read_text())["tuning"]["rmse_deg"]
    assert entry["rmse_deg"]["inclination"] == pytest.approx(tuned, abs=1e-6)


def test_single_axis_design_has_null_for_the_others(hostkit, recording: str) -> None:
    hostkit(
        "tune",
        recording,
        "-o",
        "d.json",
        "--axes",
        "pitch",
        "--tilt",
        "arcsin",
        "--objective",
        "mae",
        "--iterations",
        "5",
    )
    _, out, _ = hostkit("evaluate", "d.json", recording, "--json")
    rmse = json.loads(out)["recordings"][0]["rmse_deg"]
    assert rmse["roll"] is None
    assert rmse["inclination"] is None
    assert rmse["pitch"] > 0


def test_generate_check_build(hostkit, design: str) -> None:
    code, out, _ = hostkit("generate", design, "--target", "host", "--out", "fw", "--json")
    document = json.loads(out)
    assert code == 0
    assert document["stale"] == document["files"]
    assert hostkit("generate", design, "--target", "host", "--out", "fw", "--check")[0] == 0
    victim = Path("fw/hk_filter.c")
    victim.write_text(victim.read_text().replace("31", "30", 1) + "\n")
    code, _, err = hostkit("generate", design, "--target", "host", "--out", "fw", "--check")
    assert code == 1
    assert "hk_filter.c" in err


def test_generate_keeps_the_options_and_states_the_budget(hostkit, design: str) -> None:
    call = ("generate", design, "--target", "host", "--out", "fw")
    code, out, _ = hostkit(*call, "--message", "RAW_IMU=50", "--system-id", "7")
    assert code == 0
    assert "RAW_IMU 50 Hz" in out.splitlines()[1]
    assert "of 40000 bytes/s (80 % of 500000 baud)" in out.splitlines()[1]
    assert hostkit(*call, "--check")[0] == 0
    code, _, err = hostkit(*call, "--check", "--system-id", "8")
    assert (code, "hk_design.h" in err) == (1, True)
    document = json.loads(hostkit(*call, "--message", "RAW_IMU=50", "--json")[1])
    assert document["options"]["messages_hz"] == {"RAW_IMU": 50.0}
    assert document["link"]["bytes_per_s"] == sum(
        m["rate_hz"] * m["frame_bytes"] for m in document["link"]["messages"]
    )


def test_emulate_takes_the_options_or_those_of_the_code(
    hostkit, recording: str, design: str
) -> None:
    call = ("emulate", design, "--target", "host", "--recording", recording)
    hostkit("generate", design, "--target", "host", "--out", "fw", "--message", "TILT_SAMPLE=0")
    code, _, err = hostkit(*call, "--code", "fw", "--system-id", "7")
    assert (code, "options that it was made with" in err) == (2, True)
    for options in (("--code", "fw"), ("--message", "TILT_SAMPLE=0")):
        code, _, err = hostkit(*call, *options)
        assert (code, "TILT_SAMPLE is off" in err) == (1, True)
    document = json.loads(hostkit(*call, "--system-id", "7", "--json")[1])
    assert (document["mismatches"], document["beyond_tolerance"]) == (0, None)
    assert document["tolerance_rad"] is None


def test_edited_design_is_said_to_be_another(hostkit, recording: str, design: str) -> None:
    text = Path(design).read_text()
    eta = json.loads(text)["parameters"]["eta"]["value"]
    Path(design).write_text(text.replace(repr(eta), repr(eta * 0.99)))
    code, _, err = hostkit("evaluate", design, recording)
    assert code == 0
    assert "was edited" in err


BAD = [
    ("no such file", ("tune", "missing.csv"), 2, "missing.csv"),
    ("not a recording", ("tune", "junk.csv"), 1, "junk.csv"),
    ("left-handed mounting", ("tune", "r.csv", "--mounting", "+x+y-z"), 2, "left-handed"),
    ("unknown option value", ("tune", "r.csv", "--axes", "yaw"), 2, "yaw"),
    ("output into a missing folder", ("tune", "r.csv", "-o", "no/d.json"), 1, "no/d.json"),
    ("not a design", ("evaluate", "junk.csv", "r.csv"), 1, "not JSON"),
    ("unknown target", ("generate", "d.json", "--target", "z80", "--out", "x"), 2, "z80"),
    (
        "system id of a ground station",
        ("generate", "d.json", "--target", "host", "--out", "x", "--system-id", "255"),
        *(2, "ground station"),
    ),
    (
        "message without a rate",
        ("generate", "d.json", "--target", "host", "--out", "x", "--message", "RAW_IMU"),
        *(2, "NAME=HZ"),
    ),
    (
        "baud that cannot be made",
        ("generate", "d.json", "--target", "atmega328p", "--out", "x", "--baud", "230400"),
        *(1, "-3.5 %"),
    ),
    ("not a generated folder", ("build", "."), 1, "manifest"),
    ("port that is not there", ("monitor", "d.json", "--port", "/dev/nope"), 4, "does not exist"),
    ("unknown command", ("frobnicate",), 2, "frobnicate"),
]


@pytest.mark.parametrize(
    ("arguments", "code", "says"), [b[1:] for b in BAD], ids=[b[0] for b in BAD]
)
def test_bad_use_is_one_clear_line_with_its_exit_code(
    hostkit, design: str, arguments: tuple[str, ...], code: int, says: str
) -> None:
    Path("junk.csv").write_text("hello\nworld\n")
    before = sorted(Path().iterdir())
    got, out, err = hostkit(*arguments)
    assert (got, out) == (code, "")
    assert says in err
    assert "Traceback" not in err
    assert len(err.strip().splitlines()[-1]) > 10
    assert sorted(Path().iterdir()) == before


def test_monitor_judges_a_tlog(hostkit, design: str) -> None:
    from device import Device

    from hostkit.design_file import load_design
    from hostkit.link.logs.tlog import TlogWriter

    writer = TlogWriter(Path("f.tlog"))
    for k, frame in enumerate(Device(load_design(Path(design))).frames(100)):
        writer.write(k, frame)
    writer.close()
    code, out, _ = hostkit("monitor", design, "--port", "file:f.tlog", "--json")
    document = json.loads(out)
    assert (code, document["verdict"], document["samples"]) == (0, "pass", 100)
    wanted = "samples lost bad unknown rms_deg max_deg mismatches digest_ok verdict"
    assert set(wanted.split()) <= set(document)
    code, out, err = hostkit(
        "monitor", design, "--port", "file:f.tlog", "--max-rms-deg", "1e-9", "--json"
    )
    assert (code, json.loads(out)["verdict"]) == (3, "fail")
    assert "exceeds" in err


def test_monitor_refuses_another_digest(hostkit, recording: str, design: str) -> None:
    from device import Device

    from hostkit.design_file import load_design
    from hostkit.link.logs.tlog import TlogWriter

    writer = TlogWriter(Path("f.tlog"))
    for k, frame in enumerate(Device(load_design(Path(design))).frames(10)):
        writer.write(k, frame)
    writer.close()
    hostkit("tune", recording, "-o", "other.json", "--iterations", "3", "--axes", "roll")
    code, out, _ = hostkit("monitor", "other.json", "--port", "file:f.tlog", "--json")
    document = json.loads(out)
    assert (code, document["verdict"], document["digest_ok"]) == (3, "refused", False)


def test_project_file_environment_and_command_line(hostkit, monkeypatch, recording: str) -> None:
    Path("hostkit.toml").write_text("[tune]\nseed = 5\niterations = 4\noptimiser = 'qpso'\n")
    assert json.loads(hostkit("tune", recording, "--json")[1])["seed"] == 5
    monkeypatch.setenv("HOSTKIT_TUNE_SEED", "6")
    assert json.loads(hostkit("tune", recording, "--json")[1])["seed"] == 6
    document = json.loads(hostkit("tune", recording, "--json", "--seed", "7")[1])
    assert (document["seed"], document["evaluations"]) == (7, 100)


def test_project_file_takes_the_names_of_the_options(hostkit) -> None:
    Path("hostkit.toml").write_text("[simulate]\nduration = 3.0\ngyro-range = '250'\n")
    code, out, _ = hostkit("simulate", "--profile", "rest", "-o", "r.csv", "--json")
    assert (code, json.loads(out)["samples"]) == (0, 300)


@pytest.mark.parametrize(
    "text", ["[nonsense]\n", "tune = 1\n", "[tune\n", "[tune]\naxis = 'roll'\n"]
)
def test_broken_project_file_is_one_clear_line(hostkit, text: str) -> None:
    Path("hostkit.toml").write_text(text)
    Path("x.csv").touch()
    code, _, err = hostkit("tune", "x.csv")
    assert code == 1
    assert "hostkit.toml" in err


def test_doctor_lists_every_tool(hostkit) -> None:
    document = json.loads(hostkit("doctor", "--json")[1])
    names = {tool["name"] for tool in document["tools"]}
    assert {"gcc", "avr-gcc", "ghdl", "node", "avr8js", "clang", "vqf", "imufusion"} <= names
    for tool in document["tools"]:
        assert tool["found"] is (tool["version"] is not None) is (tool["hint"] is None)


def test_missing_tools_are_exit_code_5(hostkit, design: str, monkeypatch, tmp_path: Path) -> None:
    hostkit("generate", design, "--target", "atmega328p", "--out", "avr")
    hostkit("generate", design, "--target", "spartan3adsp", "--out", "vhdl")
    monkeypatch.setenv("PATH", str(tmp_path))
    for folder in ("avr", "vhdl"):
        code, _, err = hostkit("build", folder)
        assert code == 5
        assert "apt-get install" in err
    code, out, _ = hostkit("doctor", "--strict")
    assert code == 5
    assert "missing" in out


def test_closed_output_is_no_traceback() -> None:
    """Nobody reads: every write to standard output fails."""
    reader, writer = os.pipe()
    os.close(reader)
    command = [sys.executable, "-m", "hostkit", "doctor", "--json"]
    done = subprocess.run(
        command, stdout=writer, stderr=subprocess.PIPE, text=True, timeout=60, check=False
    )
    os.close(writer)
    assert (done.returncode, done.stderr) == (1, "")


@pytest.mark.parametrize("option", ["--max-rms-deg", "--max-lost-percent", "--duration"])
@pytest.mark.parametrize("value", ["nan", "inf", "-1"])
def test_threshold_that_nothing_can_exceed_is_refused(
    hostkit, design: str, option: str, value: str
) -> None:
    code, out, err = hostkit("monitor", design, "--port", "file:f.tlog", option, value)
    assert (code, out) == (2, "")
    assert option in err
