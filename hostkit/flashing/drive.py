"""The drive that a Pico shows while BOOTSEL was held when it was plugged in."""

import glob
from pathlib import Path

MARK = "INFO_UF2.TXT"
"""File by which a drive of a UF2 boot loader is known."""
MOUNTS = (
    *("/media/*/RPI-RP2", "/run/media/*/RPI-RP2", "/media/RPI-RP2", "/mnt/RPI-RP2"),
    "/Volumes/RPI-RP2",
)


def find_drives(mounts: tuple[str, ...] = MOUNTS) -> tuple[Path, ...]:
    """Return mounted drives of UF2 boot loaders, sorted.

    Parameters
    ----------
    mounts
        Patterns of the places where systems mount them.
    """
    # The patterns are absolute, which Path.glob does not take.
    found = (Path(name) for pattern in mounts for name in glob.glob(pattern))  # noqa: PTH207
    return tuple(sorted(drive for drive in found if is_drive(drive)))


def is_drive(folder: Path) -> bool:
    """Tell whether a folder is the drive of a UF2 boot loader."""
    return (folder / MARK).is_file()
