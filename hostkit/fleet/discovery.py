"""Finding the devices of a fleet: which recordings in a folder belong together."""

import os
from collections.abc import Iterator
from pathlib import Path

from hostkit.errors import RecordingError
from hostkit.fleet.records import Device, GroupBy
from hostkit.recordings import SUFFIXES

RESERVED_NAME = "fleet"
"""``fleet.json`` is the summary, so no device can have this name."""

NAME_LIMIT_BYTES = 200
"""A design and its temporary file are named after the device; file systems end at 255 bytes."""


def find_devices(folder: Path, group_by: GroupBy, *, leave_out: Path) -> tuple[Device, ...]:
    """Return the devices of a fleet in order of name, without opening a recording.

    Names that begin with a dot are not looked at, nor are files that do not end as recordings do.

    Parameters
    ----------
    folder
        The fleet's folder, absolute.
    group_by
        ``folder``: the recordings directly in a sub-folder are one device. ``prefix``: those
        directly in `folder` whose names agree up to the first underscore are.
    leave_out
        A sub-folder that is no device, because designs are written there; absolute.

    Raises
    ------
    RecordingError
        If the folder cannot be read, holds no device, or, by folder, holds recordings outside of
        any device.
    """
    try:
        devices = _by_folder(folder, leave_out) if group_by == "folder" else _by_prefix(folder)
    except OSError as error:
        raise RecordingError(f"{folder} cannot be read: {error.strerror or error}") from error
    if not devices:
        wanted = "a sub-folder for each device" if group_by == "folder" else "DEVICE_*.csv or .npz"
        raise RecordingError(f"{folder} holds no device; grouped by {group_by} it needs {wanted}")
    return tuple(sorted(devices, key=lambda device: device.name))


def _by_folder(folder: Path, leave_out: Path) -> list[Device]:
    devices, loose = [], []
    for entry in _visible(folder):
        if entry.is_dir():
            if Path(entry.path) != leave_out:
                devices.append(_folder_device(entry))
        elif _is_recording(entry):
            loose.append(entry.name)
    if loose:
        raise RecordingError(
            f"{folder} holds {len(loose)} recording(s) outside of any device folder, first "
            f"{min(loose)!r}; move them into one, or group by prefix"
        )
    return devices


def _folder_device(entry: os.DirEntry[str]) -> Device:
    try:
        files = [Path(found.path) for found in _visible(Path(entry.path)) if _is_recording(found)]
    except OSError as error:
        fault = f"its folder cannot be read: {error.strerror or error}"
        return Device(name=entry.name, files=(), fault=fault)
    return _device(entry.name, files)


def _by_prefix(folder: Path) -> list[Device]:
    groups: dict[str, list[Path]] = {}
    for entry in _visible(folder):
        if _is_recording(entry):
            stem = Path(entry.name).stem
            groups.setdefault(stem.partition("_")[0] or stem, []).append(Path(entry.path))
    return [_device(name, files) for name, files in groups.items()]


def _device(name: str, files: list[Path]) -> Device:
    return Device(name=name, files=tuple(sorted(files)), fault=_fault(name, files))


def _fault(name: str, files: list[Path]) -> str:
    if name.casefold() == RESERVED_NAME:
        return f"a device cannot be named {name!r}: {RESERVED_NAME}.json is the summary; rename it"
    if not name.isprintable() or len(os.fsencode(name)) > NAME_LIMIT_BYTES:
        return (
            f"{name!a:.80} cannot name a file: it must be printable and at most "
            f"{NAME_LIMIT_BYTES} bytes long"
        )
    return "" if files else f"its folder holds no recording ({' or '.join(SUFFIXES)})"


def _visible(folder: Path) -> Iterator[os.DirEntry[str]]:
    with os.scandir(folder) as entries:
        yield from (entry for entry in entries if not entry.name.startswith("."))


def _is_recording(entry: os.DirEntry[str]) -> bool:
    return entry.name.lower().endswith(SUFFIXES) and entry.is_file()
