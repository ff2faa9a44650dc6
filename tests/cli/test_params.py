"""``hostkit params`` with a device in Python, and with the real firmware at a real pty."""

import json
import time
from contextlib import AbstractContextManager
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import serial
from answering import AnsweringDevice, ManualClock
from boards import require_or_skip
from designs import design
from live import emulated
from pymavlink.mavparm import MAVParmDict

from hostkit.cli.main import run
from hostkit.cli.params_output import Shown
from hostkit.design_file import digest, save_design
from hostkit.link.device.parameter_entry import ParameterEntry
from hostkit.link.device.parameter_facts import parameter_facts
from hostkit.link.frames.encoder import Encoder
from hostkit.link.frames.signing import SigningKey, setup_signing_message
from hostkit.recordings import save
from hostkit.simulation import SensorErrors, simulate

DESIGN = design(accel_full_scale_g=4)
NAMES = [
    *("SYS_ID", "CAL_START", "FILT_TAU"),
    *("GYRO_BIAS_ROLL", "TILT_OFS_ROLL", "GYRO_BIAS_PITCH", "TILT_OFS_PITCH"),
]


@pytest.fixture
def device(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> AnsweringDevice:
    """A device behind every port that ``params`` opens."""
    found = AnsweringDevice(ManualClock())
    opened: list = []

    def open_link(port: str, baud: int | None, *, reconnect: bool) -> AnsweringDevice:
        opened.append((port, baud))
        return found

    found.opened = opened
    monkeypatch.setattr("hostkit.cli.link_options.open_link", open_link)
    monkeypatch.chdir(tmp_path)
    return found


def test_parameters_are_shown(device: AnsweringDevice, capsys) -> None:
    assert run(["params", "get", "--port", "P"]) == 0
    out = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in out] == list(device.values)
    assert out[2].split()[:3] == ["FILT_TAU", "2.75", "s"]
    assert device.closed


def test_those_that_are_named_are_shown_in_their_order(device: AnsweringDevice, capsys) -> None:
    assert run(["params", "get", "filt_tau", "SYS_ID", "--port", "P"]) == 0
    assert [line.split()[0] for line in capsys.readouterr().out.splitlines()] == [
        "FILT_TAU",
        "SYS_ID",
    ]
    assert run(["params", "get", "NOPE", "--port", "P"]) == 1
    assert "no parameter 'NOPE'; the device has: SYS_ID" in capsys.readouterr().err


def test_options_of_the_link_come_from_everywhere(
    device: AnsweringDevice, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert run(["params", "--port", "A", "--baud", "57600", "get"]) == 0
    assert run(["params", "--port", "A", "get", "--port", "B"]) == 0
    Path("hostkit.toml").write_text('[params]\nport = "T"\n')
    assert run(["params", "get"]) == 0
    monkeypatch.setenv("HOSTKIT_PARAMS_PORT", "E")
    assert run(["params", "get"]) == 0
    assert run(["params", "get", "--port", "B"]) == 0
    Path("hostkit.toml").unlink()
    monkeypatch.delenv("HOSTKIT_PARAMS_PORT")
    assert run(["params", "get"]) == 0
    ports = [("A", 57600), ("B", None), ("T", None), ("E", None), ("B", None), ("auto", None)]
    assert device.opened == ports


def test_what_is_in_use_after_setting_is_shown(device: AnsweringDevice, capsys) -> None:
    device.rounded = lambda value: value * (1 - 4e-6)
    assert run(["params", "set", "FILT_TAU=1.5", "TILT_OFS_ROLL=0.25", "--port", "P"]) == 0
    out, err = capsys.readouterr()
    assert "FILT_TAU 1.5 s -> in use 1.499994 s" in out
    assert "TILT_OFS_ROLL 0.25 rad -> in use 0.249999 rad" in out
    assert "when nothing was changed for 3 s" in err
    assert not device.commands


def test_store_is_sent_once_everything_is_set(device: AnsweringDevice, capsys) -> None:
    assert run(["params", "set", "FILT_TAU=1.5", "--store", "--json", "--port", "P"]) == 0
    assert device.commands == [(245, 1, 0)]
    document = json.loads(capsys.readouterr().out)
    assert document == {
        "schema": "hostkit.params/1",
        "action": "set",
        "system": 1,
        "component": 1,
        "digest": "000000000000",
        "results": [{"name": "FILT_TAU", "asked": 1.5, "in_use": 1.5, "error": None}],
        "stored": True,
    }


def test_what_needs_a_design_says_the_limit_that_does_not() -> None:
    fact = parameter_facts()["FILT_KV"]
    assert fact.range_text() == f"at least {fact.lowest:.7g} 1/s"
    assert replace(fact, lowest=None).range_text() == ""


@pytest.mark.parametrize(
    ("setting", "says"),
    [
        ("TILT_OFS_ROLL=0.75", "the device takes -0.5235987 to 0.5235987 rad; nothing was set"),
        ("SYS_ID=250", "whole numbers from 1 to 254 but not 250"),
        ("SYS_ID=1.5", "whole numbers"),
        ("TILT_OFS_ROLL=nan", "no finite number"),
        ("NOPE=1", "no parameter 'NOPE'"),
    ],
)
def test_nothing_is_set_if_one_value_cannot_be(
    device: AnsweringDevice, capsys, setting: str, says: str
) -> None:
    assert run(["params", "set", "FILT_TAU=1.0", setting]) == 1
    assert says in capsys.readouterr().err
    assert "PARAM_SET" not in device.asked


def test_what_the_device_refuses_is_told_and_the_rest_is_set(
    device: AnsweringDevice, capsys
) -> None:
    assert run(["params", "set", "FILT_TAU=5000", "TILT_OFS_ROLL=0.25", "--store"]) == 1
    out, err = capsys.readouterr()
    assert "FILT_TAU 5000 s -> not set: asked for 5000 s, the device keeps 2.75 s" in out
    assert "1 of 2 not set: FILT_TAU; set: TILT_OFS_ROLL" in err
    assert not device.commands, "half of it is not stored"


@pytest.mark.parametrize("setting", ["FILT_TAU", "FILT_TAU=", "=1", "FILT_TAU=x"])
def test_what_is_no_setting_is_wrong_use(device: AnsweringDevice, setting: str) -> None:
    assert run(["params", "set", setting]) == 2
    assert run(["params", "set", "FILT_TAU=1", "filt_tau=2"]) == 2
    assert not device.opened


def test_a_file_goes_round(device: AnsweringDevice, capsys) -> None:
    assert run(["params", "save", "a.parm"]) == 0
    assert run(["params", "diff", "a.parm"]) == 0
    before = dict(device.values)
    assert run(["params", "set", "FILT_TAU=1.5", "TILT_OFS_ROLL=0.25"]) == 0
    capsys.readouterr()
    assert run(["params", "diff", "a.parm"]) == 1
    out, err = capsys.readouterr()
    assert out.splitlines() == [
        "FILT_TAU          device 1.5 s  file 2.75 s",
        "TILT_OFS_ROLL     device 0.25 rad  file 0 rad",
    ]
    assert "differ in 2: FILT_TAU, TILT_OFS_ROLL" in err
    device.asked.clear()
    assert run(["params", "load", "a.parm"]) == 0
    assert device.asked.count("PARAM_SET") == 2, "what is in use already is not set"
    assert "2 of 4 values are in use already" in capsys.readouterr().err
    assert device.values == before


def test_a_bad_file_is_refused_before_the_port_is_opened(device: AnsweringDevice, capsys) -> None:
    Path("bad.parm").write_text("FILT_TAU 1\nSYS_ID one\n")
    for command in ("load", "diff"):
        assert run(["params", command, "bad.parm"]) == 1
        assert "bad.parm, line 2: SYS_ID has the value 'one'" in capsys.readouterr().err
    assert not device.opened


def test_a_file_with_a_name_that_the_device_lacks_sets_nothing(
    device: AnsweringDevice, capsys
) -> None:
    Path("other.parm").write_text("FILT_TAU 1\nRATE_RLL_P 0.1\n")
    assert run(["params", "load", "other.parm"]) == 1
    assert "no parameter 'RATE_RLL_P'" in capsys.readouterr().err
    assert "PARAM_SET" not in device.asked
    assert run(["params", "diff", "other.parm"]) == 1
    assert "RATE_RLL_P        device none  file 0.1" in capsys.readouterr().out


def test_another_design_is_refused(device: AnsweringDevice, capsys) -> None:
    save_design(DESIGN, Path("d.json"))
    assert run(["params", "get", "--design", "d.json"]) == 3
    assert f"runs design 000000000000, --design is {digest(DESIGN)}" in capsys.readouterr().err


def test_a_file_system_that_refuses_leaves_no_file(device: AnsweringDevice, capsys) -> None:
    assert run(["params", "save", "no/such/folder.parm"]) == 1
    assert "cannot be written" in capsys.readouterr().err


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A design, and a recording of a sensor at rest."""
    require_or_skip("gcc", "make")
    found = tmp_path_factory.mktemp("params")
    recording = simulate(
        "rest",
        duration_s=5.0,
        rate_hz=DESIGN.rate_hz,
        sensor=DESIGN.sensor,
        errors=SensorErrors(),
        rng=np.random.default_rng(1),
    )
    save(recording, found / "rest.csv")
    save_design(DESIGN, found / "design.json")
    return found


def served(folder: Path, *options: str) -> AbstractContextManager[str]:
    """The firmware of the host target behind a pseudo-terminal."""
    return emulated(folder / "design.json", "host", folder / "rest.csv", *options)


def test_a_device_with_a_secret_is_spoken_with_by_its_key(
    folder: Path, tmp_path: Path, capsys
) -> None:
    key_file = tmp_path / "key"
    key_file.write_bytes(bytes(range(32)))
    key_file.chmod(0o600)
    key = SigningKey.read(key_file)
    with served(folder, "--signing") as port:
        with serial.Serial(port, timeout=60.0) as first:
            assert first.read(500)
            first.write(Encoder(key).pack(setup_signing_message(key, 1, time.time())))
            first.flush()
            assert first.read(2000)
        words = ["set", "FILT_TAU=1.5", "--port", port, "--signing-key", str(key_file), "--json"]
        assert run(["params", *words]) == 0
    (result,) = json.loads(capsys.readouterr().out)["results"]
    assert result["in_use"] == pytest.approx(1.5, rel=1e-5)


def test_the_firmware_s_parameters_go_through_all_of_it(
    folder: Path, tmp_path: Path, capsys
) -> None:
    with served(folder) as port:
        go_through_all(port, folder / "design.json", tmp_path, capsys)


def go_through_all(port: str, design_file: Path, tmp_path: Path, capsys) -> None:
    file = str(tmp_path / "bench.parm")

    def params(*words: str, code: int = 0, known: bool = True) -> dict:
        design = ["--design", str(design_file)] if known else []
        assert run(["params", *words, "--port", port, *design, "--json"]) == code
        return json.loads(capsys.readouterr().out)

    got = params("get")
    assert [row["name"] for row in got["parameters"]] == NAMES
    assert set(parameter_facts(DESIGN)) == set(NAMES)
    assert got["digest"] == digest(DESIGN)
    of_filter = [row for row in got["parameters"] if row["design_value"] is not None]
    assert [row["name"] for row in of_filter] == NAMES[2:]
    assert all(row["value"] == row["design_value"] for row in of_filter)
    tau = got["parameters"][2]
    assert tau["value"] == tau["design_value"] == pytest.approx(2.8471, rel=1e-4)
    assert tau["eta"] == pytest.approx(0.9965, abs=1e-6)
    params("save", file)
    (result,) = params("set", "FILT_TAU=1.5", "--store")["results"]
    assert result["in_use"] == pytest.approx(1.5, rel=1e-5)
    assert [d["name"] for d in params("diff", file, code=1)["differences"]] == ["FILT_TAU"]
    refused = params("set", "FILT_TAU=1e7", code=1, known=False)["results"][0]
    assert refused["in_use"] == result["in_use"]
    assert "the device keeps 1.5" in refused["error"]
    theirs = MAVParmDict()
    theirs.load(file)
    theirs["TILT_OFS_ROLL"] = 0.01
    theirs.save(file)
    capsys.readouterr()
    done = params("load", file)["results"]
    assert [row["name"] for row in done] == ["FILT_TAU", "TILT_OFS_ROLL"]
    assert done[0]["in_use"] == tau["value"]
    assert params("diff", file)["differences"] == []


def test_what_says_the_same_as_a_value_is_null_where_no_rate_is_known() -> None:
    entry = ParameterEntry(name="FILT_TAU", value=0.49, index=0)
    for rate_hz, eta in ((None, None), (100.0, pytest.approx(0.98))):
        row = Shown(facts=parameter_facts(), rate_hz=rate_hz, measured=False).row(entry)
        assert row["eta"] == eta
    assert "eta" not in Shown(facts=parameter_facts(), rate_hz=100.0, measured=False).row(
        ParameterEntry(name="SYS_ID", value=1.0, index=1)
    )
