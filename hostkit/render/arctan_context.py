"""What templates see of the arc tangent: its tables, as the rows of an array."""

from dataclasses import dataclass

from hostkit.spec import ArctanTable

PER_ROW = 8


@dataclass(frozen=True, slots=True, kw_only=True)
class ArctanContext:
    """Rows of numbers with commas between them, but for the end of a row.

    Attributes
    ----------
    angle_rows, stretch_rows
        The angle of each turn, and what it adds to a length.
    turns
        How many turns there are.
    """

    angle_rows: tuple[str, ...]
    stretch_rows: tuple[str, ...]
    turns: int


def arctan_context(table: ArctanTable) -> ArctanContext:
    """Lay out the tables of the arc tangent."""
    return ArctanContext(
        angle_rows=table_rows(table.angles_raw),
        stretch_rows=table_rows(table.stretches_raw),
        turns=len(table.angles_raw),
    )


def table_rows(values: tuple[int, ...]) -> tuple[str, ...]:
    """Return the numbers of a table as rows, commas between them."""
    return tuple(
        ", ".join(map(str, values[i : i + PER_ROW])) for i in range(0, len(values), PER_ROW)
    )
