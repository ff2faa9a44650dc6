"""Loading, with programs on the PATH that only write down how they were called."""

import json
import os
from dataclasses import dataclass
from pathlib import Path

import pytest
from boards import generated, require_or_skip
from fake_ports import Cable, wait_until

from hostkit.cli import flash as command
from hostkit.cli.main import run
from hostkit.errors import ToolMissingError
from hostkit.flashing import drive as drives
from hostkit.flashing import loading
from hostkit.flashing.programmer import PROGRAMMERS
from hostkit.link.ports.transport import open_link

IMAGES = {"atmega328p": "firmware.hex", "rp2040": "firmware.uf2", "stm32f103": "firmware.bin"}


@dataclass(frozen=True)
class Bench:
    """A folder of programs that is the whole PATH, and generated code per target."""

    folder: Path
    capture: pytest.CaptureFixture[str]

    def install(self, program: str, exit_code: int = 0) -> None:
        script = self.folder / "bin" / program
        log = self.folder / f"{program}.json"
        script.write_text(
            "#!/bin/sh\n"
            f'{{ pwd; for word; do echo "$word"; done; }} > {log}\n'
            f"echo said by {program}\nexit {exit_code}\n"
        )
        script.chmod(0o755)

    def called(self, program: str) -> list[str] | None:
        log = self.folder / f"{program}.json"
        return log.read_text().splitlines() if log.is_file() else None

    def code(self, target: str, *, built: bool = True) -> Path:
        folder = generated(target, self.folder / target)
        if built and target in IMAGES:
            for name in (IMAGES[target], "firmware.elf"):
                (folder / name).write_bytes(b"image")
        return folder

    def flash(self, *arguments: str | Path) -> tuple[int, str, str]:
        code = run(["flash", *map(str, arguments)])
        out, err = self.capture.readouterr()
        return code, out, err


@pytest.fixture
def bench(tmp_path: Path, monkeypatch, capfd) -> Bench:
    (tmp_path / "bin").mkdir()
    monkeypatch.setenv("PATH", str(tmp_path / "bin"))
    monkeypatch.setattr(loading, "find_drives", lambda: ())
    return Bench(folder=tmp_path, capture=capfd)


@pytest.fixture
def port(tmp_path: Path) -> str:
    path = tmp_path / "ttyACM0"
    path.touch()
    return str(path)


def pico_drive(folder: Path, name: str = "RPI-RP2") -> Path:
    drive = folder / name
    drive.mkdir(parents=True)
    (drive / "INFO_UF2.TXT").write_text("UF2 Bootloader v3.0\n")
    return drive


def test_avrdude_is_called_in_the_folder_with_the_port(bench: Bench, port: str) -> None:
    bench.install("avrdude")
    folder = bench.code("atmega328p")
    code, out, err = bench.flash(folder, "--port", port, "--no-build", "--boot-baud", "57600")
    words = f"-p atmega328p -c arduino -P {port} -b 57600 -D -U flash:w:firmware.hex:i"
    assert bench.called("avrdude") == [str(folder), *words.split()]
    assert (code, out) == (0, "atmega328p: loaded by avrdude\n")
    assert f"in {folder}: avrdude {words}" in err
    assert "said by avrdude" in err


@pytest.mark.parametrize(
    ("target", "installed", "words"),
    [
        ("stm32f103", ("st-flash", "openocd"), "--reset write firmware.bin 0x08000000"),
        (
            "stm32f103",
            ("openocd",),
            "-f interface/stlink.cfg -f target/stm32f1x.cfg "
            "-c|program firmware.elf verify reset exit",
        ),
        ("rp2040", ("picotool", "openocd"), "load -v -x firmware.uf2"),
        (
            "rp2040",
            ("openocd",),
            "-f interface/cmsis-dap.cfg -f target/rp2040.cfg "
            "-c|program firmware.elf verify reset exit",
        ),
    ],
)
def test_the_first_that_is_installed_is_taken(bench, target, installed, words) -> None:
    for program in installed:
        bench.install(program)
    folder = bench.code(target)
    code, out, _ = bench.flash(folder, "--no-build", "--json")
    plain, *last = words.split("|")
    assert bench.called(installed[0]) == [str(folder), *plain.split(), *last]
    assert [bench.called(other) for other in installed[1:]] == [None] * (len(installed) - 1)
    document = json.loads(out)
    assert (code, document["programmer"], document["flashed"]) == (0, installed[0], True)
    assert document["command"] == [installed[0], *plain.split(), *last]


@pytest.mark.parametrize(("port", "more"), [(None, []), ("COM3", ["--upload-port", "COM3"])])
def test_platformio_is_taken_only_by_name_and_builds_by_itself(bench, port, more) -> None:
    bench.install("pio")
    folder = bench.code("stm32f103", built=False)
    assert bench.flash(folder)[0] == ToolMissingError.exit_code
    options = [] if port is None else ["--port", port]
    assert bench.flash(folder, "--programmer", "pio", *options)[0] == 0
    assert bench.called("pio") == [str(folder), "run", "-t", "upload", *more]


def test_the_exit_code_of_the_programmer_is_an_error_that_names_it(bench, port: str) -> None:
    bench.install("avrdude", exit_code=7)
    code, out, err = bench.flash(bench.code("atmega328p"), "--port", port, "--no-build")
    assert (code, out) == (4, "")
    assert "avrdude failed with exit code 7" in err


def test_a_dry_run_says_the_command_and_runs_nothing(bench: Bench, port: str) -> None:
    bench.install("avrdude")
    folder = bench.code("atmega328p", built=False)
    code, out, err = bench.flash(folder, "--port", port, "--dry-run", "--json")
    assert (code, json.loads(out)["flashed"]) == (0, False)
    assert "avrdude -p atmega328p" in err
    assert bench.called("avrdude") is None
    assert not (folder / "firmware.hex").exists()


def test_what_is_not_built_is_built_first(bench: Bench, monkeypatch, port: str) -> None:
    monkeypatch.setenv("PATH", f"{bench.folder / 'bin'}:{os.defpath}:/usr/local/bin")
    require_or_skip("make", "avr-gcc")
    bench.install("avrdude")
    folder = bench.code("atmega328p", built=False)
    code, _, err = bench.flash(folder, "--port", port, "--no-build")
    assert (code, "build it first" in err) == (1, True)
    assert bench.flash(folder, "--port", port)[0] == 0
    assert (folder / "firmware.hex").stat().st_size > 1000
    assert bench.called("avrdude") is not None


def test_the_image_is_copied_to_the_only_drive(bench: Bench, monkeypatch) -> None:
    drive = pico_drive(bench.folder / "media")
    patterns = (str(bench.folder / "media" / "*"),)
    monkeypatch.setattr(loading, "find_drives", lambda: drives.find_drives(patterns))
    folder = bench.code("rp2040")
    (bench.folder / "media" / "stick").mkdir()
    code, out, err = bench.flash(folder, "--no-build")
    assert (code, out) == (0, "rp2040: loaded by uf2\n")
    assert (drive / "firmware.uf2").read_bytes() == b"image"
    assert f"cp firmware.uf2 {drive}" in err
    pico_drive(bench.folder / "media", "RPI-RP2-2")
    code, _, err = bench.flash(folder, "--no-build")
    assert (code, "several are" in err) == (4, True)
    assert bench.flash(folder, "--no-build", "--port", drive)[0] == 0


BAD = [
    ("no port", "atmega328p", ("--programmer", "avrdude"), 4, "needs --port"),
    (
        "port that is not there",
        "atmega328p",
        ("--port", "/dev/nope"),
        4,
        "/dev/nope does not exist",
    ),
    ("port of no use", "stm32f103", ("--programmer", "st-flash", "--port", "x"), 1, "no --port"),
    ("no drive", "rp2040", ("--programmer", "uf2"), 4, "hold BOOTSEL"),
    ("a folder that is no drive", "rp2040", ("--programmer", "uf2", "--port", "/"), 4, "no drive"),
    ("another board's", "rp2040", ("--programmer", "avrdude"), 1, "picotool, uf2, openocd, pio"),
    ("not installed", "rp2040", ("--programmer", "picotool"), 5, "raspberrypi/picotool"),
    ("no hardware", "host", (), 1, "host is not flashed"),
    ("no firmware", "spartan3adsp", (), 1, "spartan3adsp is not flashed"),
    ("unknown programmer", "rp2040", ("--programmer", "hammer"), 2, "hammer"),
]


@pytest.mark.parametrize(
    ("target", "options", "code", "says"), [b[1:] for b in BAD], ids=[b[0] for b in BAD]
)
def test_what_cannot_be_is_one_clear_line(bench, target, options, code, says) -> None:
    for program in ("avrdude", "st-flash", "openocd"):
        bench.install(program)
    got, out, err = bench.flash(bench.code(target), "--no-build", *options)
    assert (got, out) == (code, "")
    assert says in err
    assert all(bench.called(p) is None for p in ("avrdude", "st-flash", "openocd"))


@pytest.mark.parametrize("target", IMAGES)
def test_without_any_programmer_every_one_is_named(bench: Bench, target: str) -> None:
    code, _, err = bench.flash(bench.code(target), "--no-build")
    assert code == 5
    for way in PROGRAMMERS:
        if way.target == target and not way.by_name_only:
            assert f"{way.name}: {way.hint}" in err


def test_a_port_that_may_not_be_opened_says_so(bench: Bench, port: str, monkeypatch) -> None:
    bench.install("avrdude")
    monkeypatch.setattr(loading.os, "access", lambda path, mode: path != port)
    code, _, err = bench.flash(bench.code("atmega328p"), "--no-build", "--port", port)
    assert (code, "dialout" in err) == (4, True)


def test_port_that_is_being_watched_is_released_for_the_time_of_loading(
    bench: Bench, tmp_path: Path, monkeypatch
) -> None:
    bench.install("avrdude")
    folder = bench.code("atmega328p")
    cable = Cable(tmp_path)
    link = open_link(str(cable.path), 500_000)
    states = []
    monkeypatch.setattr(command, "run_flash", lambda *_, **__: states.append(link.state))
    code, _, err = bench.flash(folder, "--port", cable.path, "--no-build")
    assert (code, states) == (0, ["released"])
    assert f"another hostkit process has released {cable.path}" in err
    wait_until(lambda: link.state == "connected")
    link.close()
    assert "released" not in bench.flash(folder, "--port", cable.path, "--no-build")[2]
    cable.close()
