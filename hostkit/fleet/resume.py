"""Resuming: which devices of a fleet need no work, or must not be touched."""

import hashlib
from pathlib import Path

from hostkit.design_file import digest, edited_by_hand, load_design
from hostkit.errors import DesignError
from hostkit.fleet.journal import Journal
from hostkit.fleet.records import Device, DeviceResult, designed, failed
from hostkit.records import FilterDesign

CHUNK_BYTES = 2**16


def settled(
    device: Device, path: Path, journal: Journal, *, fingerprint: str, redo: bool
) -> DeviceResult | None:
    """Return the result of a device that is not to be tuned now, or None if it is.

    A device is skipped where its design is the one the journal remembers, with the same
    fingerprint, and the bytes of its recordings have the digests that the design names. A design
    that is not what hostkit wrote is somebody's work: it fails the device rather than be lost.

    Parameters
    ----------
    path
        Where the device's design is, if there is one.
    fingerprint
        Of the options of this run.
    redo
        Tune every sound device, whatever is there.
    """
    count = len(device.files)
    if device.fault:
        return failed(device.name, count, device.fault)
    if redo or not path.exists():
        return None
    try:
        design = load_design(path)
        made_with = journal.fingerprint(device.name, digest(design))
        replaced = made_with is None and journal.knows(device.name)
        foreign = replaced or edited_by_hand(path)
    except DesignError as error:
        return failed(device.name, count, f"{error}; move it away, or --redo replaces it")
    if foreign:
        return failed(device.name, count, _edited(path, design))
    if made_with == fingerprint and _tuned_on(design, device.files):
        return designed(device.name, "skipped", count, design)
    return None


def _edited(path: Path, design: FilterDesign) -> str:
    return (
        f"{path.name} was edited since it was tuned, it is now design {digest(design)}; move it "
        "away, or --redo replaces it"
    )


def _tuned_on(design: FilterDesign, files: tuple[Path, ...]) -> bool:
    """Tell whether files are the recordings of a design, byte for byte."""
    if design.tuning is None:
        return False
    known = design.tuning.recordings
    if [recording.name for recording in known] != [path.stem for path in files]:
        return False
    try:
        return all(r.sha256 == _sha256(path) for r, path in zip(known, files, strict=True))
    except OSError:
        return False


def _sha256(path: Path) -> str:
    """Return the digest of a file, read in pieces: recordings may be larger than memory."""
    total = hashlib.sha256()
    with path.open("rb") as stream:
        while piece := stream.read(CHUNK_BYTES):
            total.update(piece)
    return total.hexdigest()
