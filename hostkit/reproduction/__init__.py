"""The tilt paper's experiments, run again."""

from hostkit.reproduction.results import (
    AcceptanceRow,
    FigureResult,
    Finding,
    Reproduction,
    Series,
    TableRow,
)
from hostkit.reproduction.run import reproduce

__all__ = [
    "AcceptanceRow",
    "FigureResult",
    "Finding",
    "Reproduction",
    "Series",
    "TableRow",
    "reproduce",
]
