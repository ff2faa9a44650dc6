"""Images that are too large: what is said, and what would fit."""

import pytest

from hostkit.emulation.image_room import (
    FIFO_BYTES,
    SIGNING_BYTES,
    overflow_bytes,
    require_room,
    too_large,
)
from hostkit.errors import BuildError
from hostkit.render import FirmwareOptions
from hostkit.targets import TARGETS

AVR = TARGETS["atmega328p"]
BOTH = FirmwareOptions(signing=True, acquisition="fifo")


@pytest.mark.parametrize(
    ("options", "excess", "fits"),
    [
        (FirmwareOptions(), 1, "what fits: --target rp2040, or --target stm32f103"),
        (FirmwareOptions(signing=True), SIGNING_BYTES, "what fits: no --signing, or --target"),
        (FirmwareOptions(signing=True), SIGNING_BYTES + 1, "what fits: --target"),
        (BOTH, FIFO_BYTES, "what fits: no --signing, or --acquisition burst, or"),
        (BOTH, FIFO_BYTES + 1, "what fits: no --signing, or --target"),
        (BOTH, SIGNING_BYTES + 1, "what fits: no --signing and --acquisition burst, or --target"),
    ],
)
def test_only_what_is_enough_is_named(options: FirmwareOptions, excess: int, fits: str) -> None:
    text = str(too_large(AVR, options, excess))
    assert f"takes {32256 + excess} bytes of flash; the atmega328p has 32256" in text
    assert fits in text


def test_an_image_may_fill_what_the_boot_loader_leaves() -> None:
    require_room(AVR, BOTH, 32256)
    require_room(TARGETS["host"], BOTH, None)
    with pytest.raises(BuildError, match="takes 32257 bytes"):
        require_room(AVR, BOTH, 32257)


def test_the_largest_target_has_nothing_above_it() -> None:
    text = str(too_large(TARGETS["rp2040"], FirmwareOptions(), 5))
    assert text.endswith("what fits: a smaller filter")


@pytest.mark.parametrize(
    ("message", "excess"),
    [
        ("ld: region `text' overflowed by 1546 bytes", 1546),
        ("ld: region `FLASH' overflowed by 12 bytes", 12),
        ("ld: region `RAM' overflowed by 12 bytes", None),
        ("hk_app.c:1: error: expected ;", None),
    ],
)
def test_a_full_flash_is_told_from_other_errors(message: str, excess: int | None) -> None:
    assert overflow_bytes(message) == excess
