"""What the tests of boards, firmware and virtual sensor share."""

import shutil
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from designs import design

from hostkit.emulation.board import BoardRun, Stimulus
from hostkit.emulation.tools import require
from hostkit.errors import ToolMissingError
from hostkit.link.frames.decoder import Decoder, Frame
from hostkit.records import FilterDesign
from hostkit.render import generate, write
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import Counts, to_counts
from hostkit.sensors.mpu6050 import settle_samples
from hostkit.targets import TARGETS

BOOT, ACTIVE, CRITICAL = 1, 4, 5
RESTARTED, SATURATED = 1, 2
PICO_TOOLS = ("make", "gcc", "arm-none-eabi-gcc", "node", "rp2040js", "clang", "wasm-ld")

TARGET_TOOLS = {
    "host": ("gcc", "make"),
    "atmega328p": ("make", "avr-gcc", "node", "avr8js", "clang", "wasm-ld"),
    "rp2040": PICO_TOOLS,
    "stm32f103": ("make", "arm-none-eabi-gcc", "gcc", "unicorn"),
    "linux": ("gcc", "make"),
    "spartan3adsp": ("ghdl",),
    "ecp5": ("ghdl",),
}


def require_or_skip(*tools: str) -> None:
    if "unicorn" in tools:
        pytest.importorskip("unicorn")
    try:
        require(*tools)
    except ToolMissingError as error:
        pytest.skip(str(error))


def program_or_skip(name: str) -> None:
    """Skip where a program is missing that only tests need; its package has its name."""
    if shutil.which(name) is None:
        pytest.skip(f"{name} is not installed: sudo apt-get install {name}")


def generated(target: str, folder: Path, code: FilterDesign | None = None) -> Path:
    write(generate(code or design(), TARGETS[target]), folder)
    return folder


def copied(folder: Path, destination: Path) -> Path:
    """Copy generated code, not what was built from it."""
    ignore = shutil.ignore_patterns("build", "firmware*")
    shutil.copytree(folder, destination, ignore=ignore)
    return destination


def own_main(folder: Path, destination: Path, program: str) -> Path:
    """Copy generated code, and what was built from it, with another main.c; build it again."""
    shutil.copytree(folder, destination)
    (destination / "main.c").write_text(program, encoding="ascii")
    return destination


def changed(file: Path, old: str, new: str) -> None:
    text = file.read_text(encoding="ascii")
    assert text.count(old) == 1, f"{old!r} stands {text.count(old)} times in {file}"
    file.write_text(text.replace(old, new), encoding="ascii")


def with_baud(folder: Path, baud: int) -> None:
    """Let generated code send and receive at another rate."""
    design = folder / "hk_design.h"
    lines = design.read_text(encoding="ascii").splitlines()
    found = [i for i, line in enumerate(lines) if line.startswith("#define HK_LINK_BAUD ")]
    assert len(found) == 1
    lines[found[0]] = f"#define HK_LINK_BAUD {baud}UL"
    design.write_text("\n".join(lines) + "\n", encoding="ascii")


def stimulus(samples: int = 300, code: FilterDesign | None = None, seed: int = 3) -> Stimulus:
    """Wild motion: every row differs from its neighbours, some axes saturate."""
    code = code or design()
    rng = np.random.default_rng(seed)
    return Stimulus(
        angular_rate_rad_s=rng.normal(0.0, 3.0, (samples, 3)),
        specific_force_m_s2=rng.normal(0.0, 8.0, (samples, 3)),
        temperature_deg_c=rng.uniform(-10.0, 50.0, samples),
        settle_samples=settle_samples(code.sensor, code.rate_hz),
    )


def expected_counts(feels: Stimulus, code: FilterDesign | None = None) -> Counts:
    code = code or design()
    part = SENSORS[code.sensor.part]
    return to_counts(part, code.sensor, feels.angular_rate_rad_s, feels.specific_force_m_s2)


@dataclass(frozen=True)
class Heard:
    """What came out of a board, decoded."""

    frames: list[Frame]
    decoder: Decoder

    def of(self, name: str) -> list:
        return [frame.message for frame in self.frames if frame.name == name]

    @property
    def samples(self) -> list:
        return self.of("TILT_SAMPLE")

    @property
    def states(self) -> list[int]:
        return [message.system_status for message in self.of("HEARTBEAT")]


def hear(run: BoardRun | bytes) -> Heard:
    decoder = Decoder()
    stream = run if isinstance(run, bytes) else run.stream
    return Heard(frames=decoder.feed(stream), decoder=decoder)


def assert_every_row_once(heard: Heard, feels: Stimulus, code: FilterDesign | None = None) -> None:
    counts = expected_counts(feels, code)
    samples = heard.samples
    assert [s.sequence for s in samples] == list(range(len(feels)))
    np.testing.assert_array_equal([s.accel for s in samples], counts.accel)
    np.testing.assert_array_equal([s.gyro for s in samples], counts.gyro)
    temperature = np.floor(feels.temperature_deg_c * 340 - 12420 + 0.5)
    np.testing.assert_array_equal([s.temperature for s in samples], temperature)
    assert heard.decoder.lost_frames == heard.decoder.bad == heard.decoder.unknown == 0


class Collector:
    """Takes what a served board sends, and stops it when there is enough."""

    def __init__(self, enough: Callable[[bytes], bool]) -> None:
        self.data = b""
        self._enough = enough

    def send(self, piece: bytes) -> None:
        self.data += piece

    def stop(self) -> bool:
        return self._enough(self.data)


def with_faults(feels: Stimulus, **faults: int) -> Stimulus:
    return replace(feels, faults=replace(feels.faults, **faults))


@pytest.fixture(scope="session")
def host_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Generated code of the host target, built with sanitizers."""
    from hostkit.emulation import host_board

    require_or_skip("gcc", "make")
    folder = generated("host", tmp_path_factory.mktemp("host"))
    host_board.build(folder, sanitize=True)
    return folder


@pytest.fixture(scope="session")
def avr_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Generated code of the ATmega328P target, built."""
    from hostkit.emulation import avr_board

    require_or_skip("make", "avr-gcc", "node", "avr8js", "clang", "wasm-ld")
    folder = generated("atmega328p", tmp_path_factory.mktemp("avr"))
    avr_board.build(folder)
    return folder


@pytest.fixture(scope="session")
def pico_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Generated code of the RP2040 target, built."""
    from hostkit.emulation import rp2040_board

    require_or_skip(*PICO_TOOLS)
    folder = generated("rp2040", tmp_path_factory.mktemp("pico"))
    rp2040_board.build(folder)
    return folder


@pytest.fixture(scope="session")
def stm32_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Generated code of the STM32F103 target, built."""
    from hostkit.emulation import stm32_board

    pytest.importorskip("unicorn")
    require_or_skip("make", "arm-none-eabi-gcc", "gcc")
    folder = generated("stm32f103", tmp_path_factory.mktemp("stm32"))
    stm32_board.build(folder)
    return folder
