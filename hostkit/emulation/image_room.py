"""Whether an image fits the flash of its target, and what would."""

import re
from typing import Final

from hostkit.errors import BuildError
from hostkit.render import FirmwareOptions
from hostkit.targets import TARGETS, Target

_OVERFLOW = re.compile(r"region .(?:text|flash). overflowed by (\d+) bytes", re.IGNORECASE)

SIGNING_BYTES: Final = 4500
FIFO_BYTES: Final = 1300
"""What an option adds to the smallest target's image, at least."""


def require_room(target: Target, options: FirmwareOptions, flash_bytes: int | None) -> None:
    """Refuse an image that leaves no room for the boot loader.

    Parameters
    ----------
    flash_bytes
        What the image takes; None where the target has no flash.

    Raises
    ------
    BuildError
        If it is too large.
    """
    room = target.flash_bytes - target.loader_bytes
    if flash_bytes is not None and target.flash_bytes and flash_bytes > room:
        raise too_large(target, options, flash_bytes - room)


def overflow_bytes(message: str) -> int | None:
    """Return by how much a linker found the flash too small; None if it complains of no such thing.

    Parameters
    ----------
    message
        What it said.
    """
    found = _OVERFLOW.search(message)
    return None if found is None else int(found.group(1))


def too_large(target: Target, options: FirmwareOptions, excess_bytes: int) -> BuildError:
    """Return the error of an image that is too large by so many bytes, with what would fit."""
    room = target.flash_bytes - target.loader_bytes
    beside = f" beside a boot loader of {target.loader_bytes}" if target.loader_bytes else ""
    return BuildError(
        f"the firmware takes {room + excess_bytes} bytes of flash; the {target.name} has {room}"
        f"{beside}; what fits: {', or '.join(_what_fits(target, options, excess_bytes))}"
    )


def _what_fits(target: Target, options: FirmwareOptions, excess_bytes: int) -> tuple[str, ...]:
    savings = []
    if options.signing:
        savings.append((SIGNING_BYTES, "no --signing"))
    if options.acquisition == "fifo":
        savings.append((FIFO_BYTES, "--acquisition burst"))
    enough = tuple(what for saved, what in savings if saved >= excess_bytes)
    if not enough and sum(saved for saved, _ in savings) >= excess_bytes:
        enough = (" and ".join(what for _, what in savings),)
    larger = [other.name for other in TARGETS if other.flash_bytes > target.flash_bytes]
    return (*enough, *(f"--target {name}" for name in larger)) or ("a smaller filter",)
