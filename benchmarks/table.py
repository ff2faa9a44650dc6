"""What a benchmark prints: a table that can be pasted into a page."""

from dataclasses import dataclass

from hostkit.errors import HostkitError

MISSING = "-"
"""What stands where there is no figure."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """One table.

    Attributes
    ----------
    title
        What is measured, under which conditions.
    columns
        Heads; the first column is text, the others are figures.
    remarks
        Sentences below the table.
    """

    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    remarks: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Refuse rows that do not fit the heads."""
        for row in self.rows:
            if len(row) != len(self.columns):
                raise HostkitError(
                    f"{self.title}: a row of {len(row)} cells, {row}; the table has "
                    f"{len(self.columns)} columns"
                )

    def text(self) -> str:
        """Return the table in Markdown, its columns aligned."""
        widths = [max(map(len, column)) for column in zip(self.columns, *self.rows, strict=True)]
        rule = tuple("-" * width for width in widths)
        lines = [_line(row, widths) for row in (self.columns, rule, *self.rows)]
        parts = [self.title, "\n".join(lines), "\n".join(self.remarks)]
        return "\n\n".join(part for part in parts if part)


def _line(row: tuple[str, ...], widths: list[int]) -> str:
    first = row[0].ljust(widths[0])
    rest = [cell.rjust(width) for cell, width in zip(row[1:], widths[1:], strict=True)]
    return f"| {' | '.join([first, *rest])} |"


def figure(value: float, digits: int = 3) -> str:
    """Return a figure with so many digits, without an exponent where it is of common size."""
    if value != 0.0 and not 1e-3 <= abs(value) < 1e6:
        return f"{value:.{digits - 1}e}"
    text = f"{value:.{digits}g}"
    return f"{value:.0f}" if "e" in text else text
