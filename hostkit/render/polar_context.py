"""What templates see of the rectangular-to-polar core."""

from dataclasses import dataclass

from hostkit.filters.polar import shrinks_raw
from hostkit.render.arctan_context import table_rows
from hostkit.spec import ArctanTable


@dataclass(frozen=True, slots=True, kw_only=True)
class PolarContext:
    """Rows of the table that takes the stretch off a length, with commas between the numbers."""

    shrink_rows: tuple[str, ...]


def polar_context(table: ArctanTable) -> PolarContext:
    """Lay out the table of the polar core."""
    return PolarContext(shrink_rows=table_rows(shrinks_raw(table)))
