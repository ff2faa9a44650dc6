"""Small programs on the emulated STM32F103."""

import shutil
from pathlib import Path

import pytest
from boards import stimulus

from hostkit.emulation import stm32_board
from hostkit.emulation.virtual_sensor import VirtualSensor, compile_shared

BAUD = 500_000


@pytest.fixture
def code(stm32_folder: Path, tmp_path: Path) -> Path:
    """A copy of the code with what was built from it, so that only what is changed is built."""
    return Path(shutil.copytree(stm32_folder, tmp_path / "code"))


def machine_of(folder: Path, work: Path, **options):
    """Return a board with the image of a folder."""
    from hostkit.emulation.stm32.machine import Machine

    library = work / "sensor.so"
    if not library.exists():
        compile_shared(folder, library)
    image = (folder / "firmware.bin").read_bytes()
    sensor = VirtualSensor(library, stimulus(3))
    return Machine(image, sensor, peer_baud=BAUD, **options)


def program(code: Path, text: str) -> None:
    """Build the board layer with another main program."""
    (code / "main.c").write_text(text, encoding="ascii")
    stm32_board.build(code)
