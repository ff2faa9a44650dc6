"""Which ports there are, which is meant, and which is the same as before."""

import os
from pathlib import Path
from types import SimpleNamespace

import pytest
from fake_ports import Cable, found_by_pyserial, usb

from hostkit.errors import DeviceError
from hostkit.link.ports import finder as ports
from hostkit.link.ports.boards import BOARDS, board_of
from hostkit.link.ports.finder import (
    PortFinder,
    PortInfo,
    list_ports,
    pick_port,
    port_info,
    with_use,
)
from hostkit.link.ports.port_use import access_of, user_of

UNO = usb("/dev/ttyACM0", 0x2341, 0x0043, "5563")
NANO = usb("/dev/ttyUSB0", 0x1A86, 0x7523)
OLD = PortInfo(device="/dev/ttyS0")


def listing(*found: PortInfo):
    return lambda: found


def test_listing_says_what_is_behind_each_port(monkeypatch: pytest.MonkeyPatch) -> None:
    def comports() -> list[SimpleNamespace]:
        return [
            found_by_pyserial("/dev/ttyS0", description="n/a", vid=None, pid=None),
            found_by_pyserial(
                "/dev/ttyACM0",
                description="ttyACM0",
                vid=0x2341,
                pid=0x0043,
                serial_number="5563",
                manufacturer="Arduino (www.arduino.cc)",
            ),
            found_by_pyserial("/dev/ttyUSB0", description=None, vid=0x9999, pid=1),
        ]

    monkeypatch.setattr(ports, "sorted", list, raising=False)
    monkeypatch.setattr(ports, "comports", comports)
    old, uno, other = list_ports()
    assert (old.candidate, old.known_as, old.usb_id, old.description) == (False, "", "", "")
    assert (uno.candidate, uno.known_as, uno.usb_id) == (True, "Arduino Uno", "2341:0043")
    assert (uno.serial_number, uno.manufacturer) == ("5563", "Arduino (www.arduino.cc)")
    assert (other.candidate, other.known_as, other.serial_number) == (True, "", None)


def test_what_a_device_says_of_itself_cannot_disturb_a_terminal(monkeypatch) -> None:
    evil = found_by_pyserial(
        "/dev/ttyACM0", description="\x1b]0;owned\x07" + "x" * 500, vid=1, pid=2, serial_number="\n"
    )
    monkeypatch.setattr(ports, "comports", lambda: [evil])
    (found,) = list_ports()
    assert found.description.isprintable()
    assert len(found.description) <= 80
    assert found.serial_number is None


def test_boards_are_known_by_their_ids() -> None:
    assert board_of(0x2E8A, 0x000A) == "Raspberry Pi Pico"
    assert board_of(0x1EAF, 0x0004).startswith("Maple")
    assert board_of(0x0483, 0x374B).startswith("ST-Link")
    assert board_of(0x2341, 0xFFFF) == "Arduino"
    assert board_of(0x9999, 1) == ""
    assert all(0 < vid < 65536 and 0 <= pid < 65536 and name for (vid, pid), name in BOARDS.items())


def test_auto_takes_the_only_candidate() -> None:
    assert pick_port("auto", listing(OLD, UNO)) == "/dev/ttyACM0"
    with pytest.raises(DeviceError, match=r"any of 2: /dev/ttyACM0 .*2341:0043.*/dev/ttyUSB0"):
        pick_port("auto", listing(OLD, UNO, NANO))
    with pytest.raises(DeviceError, match="no USB serial port is here"):
        pick_port("auto", listing(OLD))


@pytest.mark.parametrize(
    ("asked", "device"),
    [
        ("usb:2341:0043", "/dev/ttyACM0"),
        ("usb:1a86:7523", "/dev/ttyUSB0"),
        ("usb:1A86:7523", "/dev/ttyUSB0"),
        ("usb:5563", "/dev/ttyACM0"),
    ],
)
def test_usb_forms(asked: str, device: str) -> None:
    assert pick_port(asked, listing(OLD, UNO, NANO)) == device


@pytest.mark.parametrize("asked", ["usb:0000:0000", "usb:", "usb:other", "usb:2341"])
def test_usb_form_that_fits_nothing_says_what_is_here(asked: str) -> None:
    with pytest.raises(DeviceError, match="matches nothing; USB serial ports here: /dev/ttyACM0"):
        pick_port(asked, listing(OLD, UNO))


def test_two_boards_of_one_kind_must_be_named() -> None:
    twin = usb("/dev/ttyACM1", 0x2341, 0x0043, "9999")
    with pytest.raises(DeviceError, match="serial number 9999"):
        pick_port("usb:2341:0043", listing(UNO, twin))
    assert pick_port("usb:9999", listing(UNO, twin)) == "/dev/ttyACM1"


def test_pattern_must_match_one(tmp_path: Path) -> None:
    for name in ("ttyA0", "ttyA1", "ttyB0"):
        (tmp_path / name).touch()
    (tmp_path / "byname").symlink_to(tmp_path / "ttyB0")
    assert pick_port(f"{tmp_path}/ttyB*", listing()) == f"{tmp_path}/ttyB0"
    assert pick_port(f"{tmp_path}/[tb]*[Be]*", listing()) in (
        f"{tmp_path}/ttyB0",
        f"{tmp_path}/byname",
    )
    with pytest.raises(DeviceError, match="any of 2"):
        pick_port(f"{tmp_path}/ttyA*", listing())
    with pytest.raises(DeviceError, match="matches nothing"):
        pick_port(f"{tmp_path}/ttyC*", listing())


@pytest.mark.parametrize("name", ["/dev/ttyUSB0", "COM3", "socket://h:1?logging=debug", ""])
def test_names_are_left_alone(name: str) -> None:
    assert pick_port(name, listing(UNO)) == name


def again(asked: str, first: tuple[PortInfo, ...], then: tuple[PortInfo, ...]) -> str:
    """Find a port among `first`, then once more among `then`."""
    here = [first]
    finder = PortFinder(asked, lambda: here[0])
    finder.find()
    here[0] = then
    return finder.find()


def moved(port: PortInfo, device: str, serial_number: str | None) -> PortInfo:
    return usb(device, port.vid or 0, port.pid or 0, serial_number)


def test_device_is_found_again_by_name_serial_number_or_kind() -> None:
    assert again("/dev/ttyACM0", (UNO,), (UNO, NANO)) == "/dev/ttyACM0"
    there = moved(UNO, "/dev/ttyACM3", "5563")
    assert again("/dev/ttyACM0", (UNO,), (NANO, there)) == "/dev/ttyACM3"
    assert again("auto", (UNO,), (NANO, there)) == "/dev/ttyACM3"
    there = moved(NANO, "/dev/ttyUSB1", None)
    assert again("/dev/ttyUSB0", (NANO,), (UNO, there)) == "/dev/ttyUSB1"


def test_another_board_is_not_taken_for_it() -> None:
    twin = moved(UNO, "/dev/ttyACM0", "9999")
    for then in ((twin,), (NANO,), ()):
        with pytest.raises(DeviceError, match="is not plugged in"):
            again("/dev/ttyACM0", (UNO,), then)
    back = moved(UNO, "/dev/ttyACM1", "5563")
    assert again("/dev/ttyACM0", (UNO,), (twin, back)) == "/dev/ttyACM1"
    two = (moved(NANO, "/dev/ttyUSB1", None), moved(NANO, "/dev/ttyUSB2", None))
    with pytest.raises(DeviceError, match="cannot be told from 2"):
        again("/dev/ttyUSB0", (NANO,), two)


def test_port_that_is_not_on_usb_is_found_by_its_name() -> None:
    assert again("/dev/pts/9", (UNO,), ()) == "/dev/pts/9"
    assert again("socket://localhost:1", (), ()) == "socket://localhost:1"


def test_use_of_a_port_is_told_without_opening_it(tmp_path: Path) -> None:
    cable = Cable(tmp_path)
    assert user_of(str(cable.path)) == ""
    descriptor = os.open(cable.real, os.O_RDWR | os.O_NOCTTY)
    assert str(os.getpid()) in user_of(str(cable.path))
    assert with_use(port_info(str(cable.path))).used_by == user_of(cable.real)
    os.close(descriptor)
    assert user_of(str(cable.path)) == ""
    cable.close()
    assert user_of(str(cable.path)) == ""
    assert access_of(str(cable.path)) == "unknown"


def test_lock_of_a_program_that_is_not_seen_is_told(tmp_path: Path) -> None:
    port = tmp_path / "tty"
    port.touch()
    status = port.stat()
    place = f"{os.major(status.st_dev):02x}:{os.minor(status.st_dev):02x}:{status.st_ino}"
    locks = tmp_path / "locks"
    locks.write_text(f"1: FLOCK  ADVISORY  WRITE 77 {place} 0 EOF\n")
    empty = tmp_path / "proc"
    empty.mkdir()
    assert user_of(str(port), proc=empty, locks=locks) == "another program"
    locks.write_text("1: FLOCK  ADVISORY  WRITE 77 00:01:2 0 EOF\n")
    assert user_of(str(port), proc=empty, locks=locks) == ""


def test_access_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    port = tmp_path / "tty"
    port.touch()
    assert access_of(str(port)) == "ok"
    monkeypatch.setattr(os, "access", lambda *_: False)
    assert access_of(str(port)) == "forbidden"
    assert access_of("COM3") == "unknown"


def test_a_pseudo_terminal_of_the_same_number_is_anothers(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr(ports, "PTY_FOLDER", f"{tmp_path}/")
    pty, link = tmp_path / "4", tmp_path / "link"
    pty.touch()
    link.symlink_to(pty)
    direct, through_link = PortFinder(str(pty)), PortFinder(str(link))
    assert direct.find() == direct.find() == str(pty)
    through_link.find()
    made = pty.stat().st_ctime_ns
    while pty.stat().st_ctime_ns == made:  # the clock of a file system ticks slowly
        pty.unlink()
        pty.touch()
    with pytest.raises(DeviceError, match="another's"):
        direct.find()
    assert through_link.find() == str(link)
