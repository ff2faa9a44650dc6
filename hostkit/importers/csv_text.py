"""The text of a foreign CSV file, cut into cells: delimiter, preamble, header and rows."""

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from hostkit.errors import RecordingError
from hostkit.importers.csv_names import is_unit

MAX_BYTES = 2**30
MAX_LINE = 20_000
MAX_COLUMNS = 1000
LOOKED_AT = 200
"""Lines from which the layout is told."""
MIN_NUMBERS = 6
DELIMITERS = (",", ";", "\t", "|", " ")
NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
PAIR = re.compile(rf"([A-Za-z_][\w./\[\]]*)\s*[:=]\s*({NUMBER})")
LABELLED = re.compile(rf"^[A-Za-z][A-Za-z/_ ]*:\s*({NUMBER}(?:[\s,;]+{NUMBER}){{5,}})\s*$")
LABELS_ONCE = ("ax", "ay", "az", "gx", "gy", "gz", "mx", "my", "mz")
"""Order behind one label for all, as in ``a/g:`` of the i2cdevlib examples."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TextTable:
    """A table of cells, by line.

    Attributes
    ----------
    names
        Names of the columns as they stand in the header; empty if there is no header.
    width
        Number of columns.
    lines
        All lines of the file; those of data have their cells separated by commas.
    rows
        Which lines are data, counted from 0.
    settings
        Pairs of name and number that stand before the header.
    remarks
        What was left out or concluded, one sentence each.
    """

    names: tuple[str, ...]
    width: int
    lines: tuple[str, ...]
    rows: tuple[int, ...]
    settings: tuple[tuple[str, float], ...] = ()
    remarks: tuple[str, ...] = ()

    def setting(self, name: str) -> float | None:
        """Return the number a name before the header has."""
        return next((value for key, value in self.settings if key == name), None)


def read_lines(path: Path) -> list[str]:
    """Read a text file.

    Raises
    ------
    RecordingError
        If it cannot be read, is too large, holds bytes that are no text, or has a line too long
        to be one.
    """
    try:
        size = path.stat().st_size
        content = path.read_bytes() if size <= MAX_BYTES else b""
    except OSError as error:
        raise RecordingError(f"it cannot be read: {error.strerror or error}") from error
    if size > MAX_BYTES:
        raise RecordingError(f"it has {size} bytes; the limit is {MAX_BYTES}: cut it into parts")
    lines = decode(content).splitlines()
    longest = max(map(len, lines), default=0)
    if longest > MAX_LINE:
        number = next(n for n, line in enumerate(lines, 1) if len(line) > MAX_LINE)
        raise RecordingError(f"line {number} has {longest} characters; the limit is {MAX_LINE}")
    return lines


def decode(content: bytes) -> str:
    """Return the text of bytes: UTF-8, UTF-16 if it says so, else Latin-1.

    Raises
    ------
    RecordingError
        If there are zero bytes, which no text has.
    """
    if content[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return content.decode("utf-16", "replace").lstrip("\ufeff")
    if b"\0" in content:
        raise RecordingError(f"byte {content.index(0)} is zero: it is no text file")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        return content.decode("latin-1")


def parse_table(lines: Sequence[str]) -> TextTable:
    """Find the table in the lines of a file.

    Raises
    ------
    RecordingError
        If no line holds six numbers, or the table has too many columns.
    """
    looked_at = [line for line in lines if line.strip()][:LOOKED_AT]
    pairs = sum(len(PAIR.findall(line)) >= MIN_NUMBERS for line in looked_at)
    labelled = sum(bool(LABELLED.match(line)) for line in looked_at)
    if pairs > len(looked_at) / 2:
        return _pairs(lines)
    if labelled > len(looked_at) / 2:
        return _labelled(lines)
    return _delimited(lines, looked_at)


def _pairs(lines: Sequence[str]) -> TextTable:
    """Cut lines such as ``AcX = 12 | AcY = 3``."""
    found = [PAIR.findall(line) for line in lines]
    names = Counter(tuple(name for name, _ in row) for row in found).most_common(1)[0][0]
    rows = [n for n, row in enumerate(found) if tuple(name for name, _ in row) == names]
    return TextTable(
        names=names,
        width=len(names),
        lines=tuple(",".join(number for _, number in row) for row in found),
        rows=tuple(rows),
        remarks=_skipped(lines, rows),
    )


def _labelled(lines: Sequence[str]) -> TextTable:
    """Cut lines such as ``a/g:`` and numbers behind."""
    cells = [_behind_label(line) for line in lines]
    width = Counter(len(row) for row in cells if row).most_common(1)[0][0]
    if width not in (6, 9):
        raise RecordingError(
            f"there are {width} numbers behind each label; 6 (force, rate) or 9 (force, rate, "
            "field) can be told apart"
        )
    rows = [n for n, row in enumerate(cells) if len(row) == width]
    label = lines[rows[0]].partition(":")[0].strip()
    said = f"behind {label!r} stand force, rate{', field' if width == 9 else ''}, x to z each"
    return TextTable(
        names=LABELS_ONCE[:width],
        width=width,
        lines=tuple(",".join(row) for row in cells),
        rows=tuple(rows),
        remarks=(said, *_skipped(lines, rows)),
    )


def _behind_label(line: str) -> list[str]:
    match = LABELLED.match(line)
    return [] if match is None else re.split(r"[\s,;]+", match.group(1))


def _skipped(lines: Sequence[str], rows: Sequence[int]) -> tuple[str, ...]:
    others = sum(bool(line.strip()) for line in lines) - len(rows)
    if not others:
        return ()
    first = next(n for n, line in enumerate(lines) if line.strip() and n not in set(rows))
    return (f"{others} line(s) are no samples and are left out, the first is {first + 1}",)


def _delimited(lines: Sequence[str], looked_at: Sequence[str]) -> TextTable:
    layout = _layout(looked_at)
    width = layout.width
    if width > MAX_COLUMNS:
        raise RecordingError(f"it has {width} columns; the limit is {MAX_COLUMNS}")
    samples = [n for n, line in enumerate(lines) if line.strip() and line[0] != "#"]
    first = next(n for n in samples if _numbers(layout.cells(lines[n])) >= MIN_NUMBERS)
    before = [layout.cells(line.lstrip("# ")) for line in lines[:first]]
    rows = [n for n in samples if n >= first]
    rows, remarks = _without_cut_end(rows, layout.cells(lines[rows[-1]]), width)
    return TextTable(
        names=_header(before, width),
        width=width,
        lines=tuple(map(layout.joined, lines)),
        rows=tuple(rows),
        settings=_settings(before),
        remarks=remarks,
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class _Layout:
    """How lines are cut into cells: delimiter, decimal comma or not, number of columns."""

    delimiter: str
    comma: bool
    width: int = 0

    def cells(self, line: str) -> list[str]:
        """Cut one line; the numbers in it have a decimal point afterwards."""
        cut = line.split() if self.delimiter == " " else line.split(self.delimiter)
        bare = [cell.strip("\"' ") for cell in cut]
        return [cell.replace(",", ".") for cell in bare] if self.comma else bare

    def joined(self, line: str) -> str:
        """Return one line with commas between its cells, without an empty one behind the last."""
        cells = self.cells(line)
        ends_empty = len(cells) == self.width + 1 and not cells[-1]
        return ",".join(cells[: self.width] if ends_empty else cells)


LAYOUTS = tuple(
    _Layout(delimiter=delimiter, comma=comma)
    for comma in (False, True)
    for delimiter in DELIMITERS
    if not (comma and delimiter == ",")
)


def _layout(lines: Sequence[str]) -> _Layout:
    """Return the layout in which most lines are rows of numbers; the first one if several are."""
    best, most = LAYOUTS[0], 0
    for layout in LAYOUTS:
        rows = [layout.cells(line) for line in lines if line[0] != "#"]
        widths = Counter(len(r) - (not r[-1]) for r in rows if r and _numbers(r) >= MIN_NUMBERS)
        if widths and widths.most_common(1)[0][1] > most:
            width, most = widths.most_common(1)[0]
            best = replace(layout, width=width)
    if not most:
        raise RecordingError(
            f"no line holds {MIN_NUMBERS} numbers with a separator between them; a sample has "
            "force and rate on three axes each"
        )
    return best


def is_number(cell: str) -> bool:
    """Tell whether a cell is a number, NaN and infinity included."""
    try:
        float(cell)
    except ValueError:
        return False
    return "_" not in cell


def _numbers(cells: Sequence[str]) -> int:
    return sum(map(is_number, cells))


def _header(before: Sequence[Sequence[str]], width: int) -> tuple[str, ...]:
    """Return the names above the first row; a line of units below them is added to them."""
    fitting = [row[:width] for row in before[-3:] if any(row) and 0 <= len(row) - width <= 1]
    if not fitting:
        return ()
    last = fitting[-1]
    filled = [cell for cell in last if cell]
    if len(fitting) > 1 and sum(map(is_unit, filled)) > len(filled) / 2:
        names = fitting[-2]
        return tuple(f"{n} [{u}]" if u else n for n, u in zip(names, last, strict=True))
    return tuple(last)


def _settings(before: Sequence[Sequence[str]]) -> tuple[tuple[str, float], ...]:
    return tuple(
        (row[0].lower(), float(row[1])) for row in before if len(row) == 2 and is_number(row[1])
    )


def _without_cut_end(
    rows: list[int], last: Sequence[str], width: int
) -> tuple[list[int], tuple[str, ...]]:
    """Leave out the last row if the file was cut in it."""
    if len(rows) > 1 and (len(last) < width or _numbers(last) < MIN_NUMBERS):
        return rows[:-1], (f"line {rows[-1] + 1}, the last one, is cut off and left out",)
    return rows, ()
