"""The subcommand ports, on pseudo-terminals and on a listing that is made up."""

import json
import os
import threading
from pathlib import Path

import pytest
from designs import design
from device import Device
from fake_ports import Cable, found_by_pyserial

from hostkit.cli.main import run
from hostkit.link.ports import finder as ports

DEVICE = Device(design())


@pytest.fixture
def hostkit(capfd: pytest.CaptureFixture[str]):
    def call(*arguments: str) -> tuple[int, str, str]:
        code = run(list(arguments))
        out, err = capfd.readouterr()
        return code, out, err

    return call


@pytest.fixture
def cable(tmp_path: Path):
    cable = Cable(tmp_path)
    yield cable
    cable.close()


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch) -> None:
    def comports() -> list[object]:
        uno = found_by_pyserial(
            "/dev/ttyACM0",
            description="ttyACM0",
            vid=0x2341,
            pid=0x0043,
            serial_number="5563",
            manufacturer="Arduino",
        )
        return [found_by_pyserial("/dev/ttyS9", description="n/a"), uno]

    monkeypatch.setattr(ports, "comports", comports)
    monkeypatch.setattr(ports, "sorted", list, raising=False)


def test_list_has_a_star_for_candidates(bench: None, hostkit) -> None:
    code, out, err = hostkit("ports")
    old, uno = out.splitlines()
    assert (code, err, old.strip()) == (0, "", "/dev/ttyS9       ttyS9")
    assert uno == "* /dev/ttyACM0     Arduino Uno; 2341:0043; serial number 5563"


def test_json_is_one_document_with_null_for_what_is_not_known(bench: None, hostkit) -> None:
    code, out, err = hostkit("ports", "--json")
    document = json.loads(out)
    assert (code, err, document["schema"]) == (0, "", "hostkit.ports/1")
    old, uno = document["ports"]
    assert uno == {
        "device": "/dev/ttyACM0",
        "description": "ttyACM0",
        "vid": "2341",
        "pid": "0043",
        "serial_number": "5563",
        "manufacturer": "Arduino",
        "known_as": "Arduino Uno",
        "candidate": True,
        "access": "unknown",
        "used_by": "",
        "probe": None,
    }
    assert (old["vid"], old["serial_number"], old["candidate"]) == (None, None, False)


def test_no_port_is_said_and_is_an_empty_list(monkeypatch: pytest.MonkeyPatch, hostkit) -> None:
    monkeypatch.setattr(ports, "comports", list)
    assert hostkit("ports")[:2] == (0, "no serial port is here\n")
    assert json.loads(hostkit("ports", "--json")[1])["ports"] == []


def test_probe_opens_candidates_only_and_an_error_is_no_end(bench: None, hostkit) -> None:
    code, out, _ = hostkit("ports", "--probe", "--json")
    old, uno = json.loads(out)["ports"]
    assert (code, old["probe"]) == (0, None)
    assert uno["probe"]["finding"] == "error"
    assert "does not exist" in uno["probe"]["text"]


def test_probe_of_a_named_port_tells_the_design_of_its_device(cable: Cable, hostkit) -> None:
    stop = threading.Event()

    def device() -> None:
        frames = DEVICE.frames(20)
        while not stop.is_set():
            for frame in frames:
                cable.send(frame)
                stop.wait(0.002)

    thread = threading.Thread(target=device)
    thread.start()
    try:
        code, out, err = hostkit("ports", str(cable.path), "--probe", "--json")
    finally:
        stop.set()
        thread.join(30)
    (port,) = json.loads(out)["ports"]
    assert (code, port["device"], err) == (0, str(cable.path), f"listening at {cable.path}\n")
    assert port["probe"]["finding"] == "mavlink2"
    assert (port["probe"]["baud"], port["probe"]["system"]) == (500_000, 1)
    assert port["probe"]["digest"] == DEVICE.digest


def test_port_in_use_is_named_and_not_opened(cable: Cable, hostkit) -> None:
    descriptor = os.open(cable.real, os.O_RDWR | os.O_NOCTTY)
    code, out, _ = hostkit("ports", str(cable.path), "--probe")
    os.close(descriptor)
    assert code == 0
    assert "pseudo-terminal; in use by" in out.splitlines()[0]
    assert f"({os.getpid()})" in out.splitlines()[0]
    assert "not opened: in use by" in out.splitlines()[1]


def test_name_that_fits_no_port_is_exit_code_4(bench: None, hostkit) -> None:
    code, out, err = hostkit("ports", "usb:9999:9999")
    assert (code, out) == (4, "")
    assert "/dev/ttyACM0 (Arduino Uno, 2341:0043, serial number 5563)" in err
