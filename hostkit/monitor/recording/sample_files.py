"""Recordings as CSV and npz, written while samples come."""

import os
import tempfile
import zipfile
from collections.abc import Iterator, Sequence
from itertools import islice
from pathlib import Path
from typing import IO

import numpy as np
from numpy.typing import NDArray

from hostkit.design_file import digest
from hostkit.errors import HostkitError
from hostkit.link.frames.decoder import Frame
from hostkit.link.logs.part_file import PartFile, PartialWriteError, Write
from hostkit.link.logs.tlog import TlogWriter
from hostkit.monitor.recording.recordings import SUFFIXES, Recorder
from hostkit.monitor.recording.sample_rows import COLUMNS, SampleRows
from hostkit.recordings.npz_file import ZIP_DATE
from hostkit.records import FilterDesign
from hostkit.sensors import SENSORS

CHUNK_ROWS = 8192
VALID = ",1\n"
MEMBERS = (("time_s", slice(0, 1)), ("gyro_rad_s", slice(1, 4)), ("accel_m_s2", slice(4, 7)))
TEMPERATURE = 7


def open_recorder(
    path: Path,
    design: FilterDesign | None,
    *,
    system: int | None = None,
    write: Write = os.write,
) -> Recorder:
    """Open a recording in the form that its suffix says.

    Parameters
    ----------
    path
        ``.tlog`` for everything that comes, ``.csv`` or ``.npz`` for the samples in SI units.
    design
        Says the ranges of the sensor; not needed for a tlog.
    system
        Id of the system whose samples are taken; None takes the first that sends any.

    Raises
    ------
    HostkitError
        If the suffix is another one, the design is missing, or the file cannot be written.
    """
    suffix = path.suffix.lower()
    if suffix == ".tlog":
        return TlogWriter(path, write=write)
    if suffix not in SUFFIXES:
        raise HostkitError(
            f"{path} ends in {suffix or 'no suffix'}; a recording ends in one of: "
            + ", ".join(SUFFIXES)
        )
    if design is None:
        raise HostkitError(f"{path} needs a design: it has the ranges of the sensor (--design)")
    kind = NpzRecorder if suffix == ".npz" else CsvRecorder
    return kind(path, design, system=system, write=write)


class CsvRecorder:
    """Writes samples as rows of a CSV recording; `NAME.part` until it is closed.

    Attributes
    ----------
    frames
        Samples that are in it.
    left
        Where an unfinished recording of that name was moved; None if there was none.
    """

    def __init__(
        self,
        path: Path,
        design: FilterDesign,
        *,
        system: int | None = None,
        write: Write = os.write,
    ) -> None:
        self.name: str = path.name
        self.frames = 0
        self._rows = SampleRows(design, system)
        self._file = PartFile(path, kind=".csv", write=write)
        self.left = self._file.left
        self._file.append([_head(design).encode()])

    @property
    def written_bytes(self) -> int:
        """Bytes in the file."""
        return self._file.written_bytes

    def add(self, epoch_us: int, frames: Sequence[Frame]) -> None:
        """Append the samples among some frames."""
        rows = self._rows.take(epoch_us, frames)
        lines = [",".join(map(repr, row)) + VALID for row in rows.tolist()]
        if not lines:
            return
        try:
            self._file.append([line.encode() for line in lines])
        except PartialWriteError as error:
            self.frames += error.kept
            raise
        self.frames += len(lines)

    def close(self) -> None:
        """Finish the file and give it its name."""
        self._file.close()


class NpzRecorder(CsvRecorder):
    """Writes samples as rows, and turns them into an npz recording when it is closed."""

    def __init__(
        self,
        path: Path,
        design: FilterDesign,
        *,
        system: int | None = None,
        write: Write = os.write,
    ) -> None:
        super().__init__(path, design, system=system, write=write)
        self._path, self._design = path, design
        self._closed = False

    def close(self) -> None:
        """Write the npz file and take away the rows; if that fails, the rows stay."""
        if self._closed:
            return
        self._closed = True
        self._file.shut()
        part = self._file.part
        try:
            _to_npz(part, self._path, self._design)
        except OSError as error:
            raise HostkitError(
                f"{self._path} cannot be written: {error.strerror or error}; {part} has the "
                f"{self.frames} samples as CSV"
            ) from error
        part.unlink()


def _texts(design: FilterDesign) -> dict[str, str]:
    title = SENSORS[design.sensor.part].title
    return {"sensor": title, "origin": f"hostkit, design {digest(design)}", "licence": ""}


def _head(design: FilterDesign) -> str:
    lines = [f"# {key}: {text}" for key, text in _texts(design).items()]
    lines += [f"# rate_hz: {design.rate_hz!r}", ",".join((*COLUMNS, "valid"))]
    return "\n".join((*lines, ""))


def _to_npz(rows: Path, path: Path, design: FilterDesign) -> None:
    """Turn rows of text into arrays with a bounded amount of memory."""
    beside = path.with_name(f".{path.name}.npz-part")
    try:
        with tempfile.TemporaryFile(dir=path.parent) as numbers:
            for chunk in _chunks(rows):
                numbers.write(chunk.tobytes())
            numbers.flush()
            count = numbers.tell() // (8 * len(COLUMNS))
            with zipfile.ZipFile(beside, "w", zipfile.ZIP_DEFLATED) as archive:
                for name, columns in (*MEMBERS, ("temp_c", slice(TEMPERATURE, TEMPERATURE + 1))):
                    _write_member(archive, name, numbers, columns, count)
                texts = {key: np.asarray(text) for key, text in _texts(design).items()}
                for name, array in {"rate_hz": np.asarray(design.rate_hz), **texts}.items():
                    with archive.open(_entry(name), "w") as member:
                        np.lib.format.write_array(member, array, allow_pickle=False)
        beside.replace(path)
    finally:
        beside.unlink(missing_ok=True)


def _chunks(rows: Path) -> Iterator[NDArray[np.float64]]:
    with rows.open(encoding="ascii") as lines:
        data = (line for line in lines if line[0] not in "#t")
        while chunk := list(islice(data, CHUNK_ROWS)):
            table = [line.split(",")[: len(COLUMNS)] for line in chunk]
            yield np.array(table, dtype=np.float64)


def _write_member(
    archive: zipfile.ZipFile, name: str, numbers: IO[bytes], columns: slice, count: int
) -> None:
    width = columns.stop - columns.start
    shape = (count, width) if width > 1 else (count,)
    head = {"descr": np.dtype(np.float64).str, "fortran_order": False, "shape": shape}
    numbers.seek(0)
    with archive.open(_entry(name), "w", force_zip64=True) as member:
        np.lib.format.write_array_header_1_0(member, head)
        while chunk := numbers.read(8 * len(COLUMNS) * CHUNK_ROWS):
            table = np.frombuffer(chunk).reshape(-1, len(COLUMNS))
            member.write(np.ascontiguousarray(table[:, columns]).tobytes())


def _entry(name: str) -> zipfile.ZipInfo:
    entry = zipfile.ZipInfo(f"{name}.npy", date_time=ZIP_DATE)
    entry.compress_type = zipfile.ZIP_DEFLATED
    return entry
