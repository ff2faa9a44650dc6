"""The generated folder as a CMake project, a PlatformIO project and an Arduino sketch."""

import json
import os
import re
import runpy
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

import pytest
from boards import assert_every_row_once, generated, hear, require_or_skip, stimulus
from designs import design

from hostkit.emulation import avr_board, host_board
from hostkit.render import generate, write
from hostkit.targets import TARGETS

CROSS = {
    "atmega328p": ("avr-gcc", ("firmware.hex",)),
    "rp2040": ("arm-none-eabi-gcc", ("firmware.bin", "firmware.uf2")),
    "stm32f103": ("arm-none-eabi-gcc", ("firmware.bin", "firmware.hex")),
}
ARDUINO = Path("/usr/share/arduino/hardware")
CTAGS = (
    '"{cmd.path}" -u --language-force=c++ -f - --c++-kinds=svpf --fields=KSTtzns '
    '--line-directives "{source_file}"'
)


def run(*command: str | Path, cwd: Path | None = None) -> str:
    done = subprocess.run(
        [str(word) for word in command],
        cwd=cwd,
        capture_output=True,
        text=True,
        timeout=110,
        check=False,
    )
    assert done.returncode == 0, f"{command}: {done.stdout[-2000:]} {done.stderr[-2000:]}"
    return done.stdout + done.stderr


def need(*programs: str) -> None:
    for program in programs:
        if shutil.which(program) is None:
            pytest.skip(f"{program} is not installed")


def cmake(folder: Path, *options: str) -> Path:
    need("cmake", "ninja")
    run("cmake", "-G", "Ninja", "-B", "build/cmake", *options, cwd=folder)
    said = run("cmake", "--build", "build/cmake", cwd=folder)
    assert "warning:" not in said
    return folder / "build" / "cmake"


def sources_of_make(folder: Path) -> list[str]:
    """The C files that make compiles, as it would print them."""
    said = run("make", "-n", "-B", cwd=folder)
    return sorted(set(re.findall(r"-c -o \S+ (\w+\.c)\b", said)))


@pytest.mark.parametrize("target", CROSS)
def test_cmake_makes_the_image_that_make_makes(target: str, tmp_path: Path) -> None:
    compiler, images = CROSS[target]
    require_or_skip("make", "gcc", compiler)
    folder = generated(target, tmp_path / "code")
    built = cmake(folder, "--toolchain", "hk_toolchain.cmake")
    run("make", cwd=folder)
    for image in images:
        assert (built / image).read_bytes() == (folder / image).read_bytes(), image


def test_the_program_that_cmake_makes_gives_every_row(tmp_path: Path) -> None:
    require_or_skip("gcc", "make")
    folder = generated("host", tmp_path / "code")
    shutil.copy(cmake(folder) / "firmware", folder / "firmware")
    feels = stimulus(100)
    assert_every_row_once(hear(host_board.run(folder, feels)), feels)


# --- PlatformIO -----------------------------------------------------------------------------------


@dataclass(frozen=True)
class Environment:
    name: str
    folder: Path
    settings: dict[str, object]

    @property
    def sources(self) -> list[str]:
        """What PlatformIO itself takes for the sources."""
        from platformio import fs

        source_filter = " ".join(self.settings["build_src_filter"])
        return sorted(fs.match_src_files(str(self.folder), source_filter, ("c", "S")))

    @property
    def flags(self) -> str:
        return " ".join(self.settings["build_flags"])


def environments(target: str, folder: Path) -> list[Environment]:
    generated(target, folder)
    command = [sys.executable, "-m", "platformio", "project", "config", "--json-output"]
    done = subprocess.run(
        [*command, "-d", str(folder)],
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
        env={**os.environ, "PLATFORMIO_CORE_DIR": str(folder.parent / "core")},
    )
    return [
        Environment(name.removeprefix("env:"), folder, dict(pairs))
        for name, pairs in json.loads(done.stdout)
        if name.startswith("env:")
    ]


@pytest.mark.parametrize(
    ("target", "platform", "boards"),
    [
        ("atmega328p", "atmelavr", ["uno", "nanoatmega328"]),
        ("rp2040", "raspberrypi", ["pico"]),
        ("stm32f103", "ststm32", ["bluepill_f103c8"]),
    ],
)
def test_platformio_reads_the_project(target, platform, boards, tmp_path: Path) -> None:
    pytest.importorskip("platformio")
    found = environments(target, tmp_path / "code")
    assert [env.name for env in found] == boards
    for env in found:
        assert (env.settings["board"], env.settings["platform"]) == (env.name, platform)
        c_files = [name for name in env.sources if name.endswith(".c")]
        assert c_files == [s for s in sources_of_make(env.folder) if s != "hk_image.c"]
        named = [*env.settings.get("extra_scripts", ()), env.settings.get("board_build.ldscript")]
        for name in filter(None, named):
            assert (env.folder / name.removeprefix("pre:")).is_file()
        assert "-isystem mavlink" in env.flags
        assert (env.folder / "mavlink").is_dir()
        assert int(env.settings["monitor_speed"]) == 500_000
        clock = f"{TARGETS[target].clock_hz}"
        assert clock in env.flags or env.settings["board_build.f_cpu"] == f"{clock}L"


class FakeScons:
    """What the extra scripts ask of PlatformIO's build environment."""

    def __init__(self, folder: Path) -> None:
        self.places = {"$BUILD_DIR": folder / "pio", "$PROJECT_DIR": folder}
        self.link: list[str] = []
        self.assembled: list[tuple[str, str]] = []

    def __getitem__(self, name: str) -> dict[str, str]:
        assert name == "ENV"
        return dict(os.environ)

    def subst(self, text: str) -> str:
        return str(self.places[text])

    def Append(self, **lists: list[str]) -> None:  # noqa: N802 - SCons names it so
        self.link += lists.get("LINKFLAGS", [])

    def Object(self, output: str, source: str) -> str:  # noqa: N802 - SCons names it so
        self.assembled.append((output, source))
        return output


def extra_script(folder: Path, monkeypatch: pytest.MonkeyPatch) -> FakeScons:
    fake = FakeScons(folder)
    package, script = ModuleType("SCons"), ModuleType("SCons.Script")
    script.DefaultEnvironment = lambda: fake
    monkeypatch.setitem(sys.modules, "SCons", package)
    monkeypatch.setitem(sys.modules, "SCons.Script", script)
    runpy.run_path(str(folder / "hk_platformio.py"))
    return fake


@pytest.mark.parametrize("target", ["rp2040", "stm32f103"])
def test_platformio_links_as_make_does(target: str, tmp_path: Path, monkeypatch) -> None:
    require_or_skip("make", "arm-none-eabi-gcc")
    folder = generated(target, tmp_path / "code")
    flags = extra_script(folder, monkeypatch).link
    line = next(s for s in run("make", "-n", "-B", cwd=folder).splitlines() if "-T hk_" in s)
    assert set(flags) <= set(line.split())
    assert {"-nostartfiles", "-Wl,--gc-sections"} <= set(flags)
    assert ("--specs=nano.specs" in line) == ("--specs=nano.specs" in flags)


def test_platformio_gives_the_loader_the_checksum_that_make_gives(
    tmp_path: Path, monkeypatch
) -> None:
    require_or_skip("make", "gcc", "arm-none-eabi-gcc")
    folder = generated("rp2040", tmp_path / "code")
    run("make", cwd=folder)
    ((_, source),) = extra_script(folder, monkeypatch).assembled
    by_make = (folder / "build" / "hk_boot2_crc.S").read_text().split()
    assert Path(source).read_text().split() == by_make


# --- Arduino --------------------------------------------------------------------------------------


def sketch(tmp_path: Path, name: str = "tilt") -> Path:
    folder = tmp_path / name
    write(generate(design(), TARGETS["atmega328p"], folder=folder), folder)
    return folder


def test_a_sketch_has_the_name_of_its_folder_and_other_targets_have_none(tmp_path: Path) -> None:
    assert [path.name for path in sketch(tmp_path).glob("*.ino")] == ["tilt.ino"]
    for name in ("a b", "tilt.", "x" * 64, "-tilt"):
        assert not list(sketch(tmp_path, name).glob("*.ino")), name
    for target in ("host", "rp2040", "stm32f103", "spartan3adsp"):
        files = generate(design(), TARGETS[target], folder=tmp_path / "tilt")
        assert not [file.path for file in files if file.path.endswith(".ino")]


def test_what_the_arduino_builder_makes_runs_on_the_emulated_board(tmp_path: Path) -> None:
    """Debian's avr-gcc lacks a macro that the core's String wants; it is nothing of ours."""
    need("arduino-builder", "arduino-ctags")
    require_or_skip("make", "avr-gcc", "node", "avr8js", "clang", "wasm-ld")
    folder, built = sketch(tmp_path), tmp_path / "built"
    built.mkdir()
    said = run(
        *("arduino-builder", "-compile", "-hardware", ARDUINO, "-tools", "/usr/bin"),
        *("-hardware", "/usr/share/arduino-builder", "-fqbn", "arduino:avr:uno"),
        *("-build-path", built, "-warnings", "all"),
        "-prefs=compiler.cpp.extra_flags=-DDECIMAL_DIG=17",
        *("-prefs=tools.ctags.path=/usr/bin", f"-prefs=tools.ctags.pattern={CTAGS}"),
        "-prefs=tools.ctags.cmd.path=/usr/bin/arduino-ctags",
        folder / "tilt.ino",
    )
    warnings = [line for line in said.splitlines() if "warning:" in line]
    assert [line for line in warnings if not line.startswith(str(ARDUINO))] == []
    shutil.copy(built / "tilt.ino.hex", folder / "firmware.hex")
    feels = stimulus(100)
    assert_every_row_once(hear(avr_board.run(folder, feels)), feels)
    names = run("avr-nm", built / "tilt.ino.elf")
    assert " T main\n" in names
    assert " loop\n" not in names
