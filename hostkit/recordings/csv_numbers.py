"""The numbers of a CSV file: read fast, and slowly only to say where one is wrong."""

import csv
from collections.abc import Collection, Sequence

import numpy as np

from hostkit.errors import RecordingError
from hostkit.recordings.recording import Vector


def parse_numbers(
    lines: Sequence[str],
    rows: Sequence[int],
    header: Sequence[str],
    wanted: Sequence[str],
    may_be_empty: Collection[str],
) -> Vector:
    """Read the wanted columns of a table.

    Parameters
    ----------
    lines
        All lines of the file.
    rows
        Which lines are data rows, counted from 0.
    header
        Names of all columns.
    wanted
        Names of the columns to read; the others may hold anything.
    may_be_empty
        Names of the columns in which an empty cell stands for NaN.

    Returns
    -------
    numpy.ndarray
        Values, shape ``(rows, wanted)``.

    Raises
    ------
    RecordingError
        If a row has another number of cells than the header, or a cell is not a number.
    """
    if not rows:
        return np.empty((0, len(wanted)))
    places = [header.index(name) for name in wanted]
    text = [lines[row] for row in rows]
    if not _even(text, len(header)):
        return _read_slowly(lines, rows, header, places, may_be_empty)
    try:
        return np.loadtxt(text, delimiter=",", usecols=places, ndmin=2, comments=None)
    except ValueError:
        return _read_slowly(lines, rows, header, places, may_be_empty)


def _even(text: Sequence[str], width: int) -> bool:
    return all(line.count(",") == width - 1 for line in text)


def _read_slowly(
    lines: Sequence[str],
    rows: Sequence[int],
    header: Sequence[str],
    places: Sequence[int],
    may_be_empty: Collection[str],
) -> Vector:
    values = np.empty((len(rows), len(places)))
    for out, row in zip(values, rows, strict=True):
        cells = _cells(lines[row], row + 1, len(header))
        for column, place in enumerate(places):
            out[column] = _number(cells[place], row + 1, header[place], may_be_empty)
    return values


def _cells(line: str, number: int, width: int) -> list[str]:
    try:
        cells = next(csv.reader([line], strict=True))
    except csv.Error as error:
        raise RecordingError(f"line {number} is not CSV: {error}") from error
    if len(cells) != width:
        raise RecordingError(
            f"line {number} has {len(cells)} cells; the header has {width} columns"
        )
    return cells


def _number(cell: str, number: int, name: str, may_be_empty: Collection[str]) -> float:
    text = cell.strip()
    if not text and name in may_be_empty:
        return float("nan")
    try:
        if "_" in text:
            raise ValueError
        return float(text)
    except ValueError:
        raise RecordingError(
            f"line {number}, column {name}: {text[:40]!r} is not a number"
        ) from None
