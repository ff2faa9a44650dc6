"""What the reproduction says: rows, figures and findings, the paper's word beside ours."""

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from hostkit.records import read_only

Vector = NDArray[np.float64]
Unit = Literal["", "rad", "rad/s", "share"]
Verdict = Literal["holds", "holds in part", "does not hold", "inferred"]


@dataclass(frozen=True, slots=True, kw_only=True)
class AcceptanceRow:
    """One figure of the paper, or one that it should have had, beside what was measured here.

    Attributes
    ----------
    figure
        What is compared.
    paper
        What the paper says of it, in its own form.
    ours
        What this run measured; infinite where it never happened.
    unit
        Of `ours` and of the band.
    low, high
        Band in which `ours` must lie, both ends included; `low` is infinite where there is only an
        upper end, both are None where the figure is only shown.
    """

    figure: str
    paper: str
    ours: float
    unit: Unit = ""
    low: float | None = None
    high: float | None = None

    @property
    def is_only_shown(self) -> bool:
        """Whether nothing is asked of the figure."""
        return self.low is None or self.high is None

    @property
    def holds(self) -> bool | None:
        """Whether the figure lies in its band; None where it is only shown."""
        if self.low is None or self.high is None:
            return None
        return self.low <= self.ours <= self.high

    @property
    def text(self) -> str:
        """The measured figure in words of its unit."""
        return in_words(self.ours, self.unit)

    @property
    def band(self) -> str:
        """The band in words of its unit."""
        if self.low is None or self.high is None:
            return "shown"
        high = in_words(self.high, self.unit)
        if self.low == self.high:
            return high
        if not math.isfinite(self.low):
            return f"up to {high}"
        return f"{in_words(self.low, self.unit).split()[0]} to {high}"


@dataclass(frozen=True, slots=True, kw_only=True)
class TableRow:
    """A row of Table 1, or one that the paper does not have.

    Attributes
    ----------
    algorithm
        The optimiser, and how it searched where that is not the paper's way.
    paper
        Best, worst, mean and eta as printed; None where the paper has no such row.
    best_rad, worst_rad, mean_rad
        Test error of ten groups, medians over logs and runs.
    eta_pooled, eta_median
        Optimum of all ten groups together, median over logs; and median over single groups.
    """

    algorithm: str
    paper: tuple[float, float, float, float] | None
    best_rad: float
    worst_rad: float
    mean_rad: float
    eta_pooled: float
    eta_median: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Series:
    """One line of a figure: `x` and `y` of shape ``(K,)``."""

    label: str
    x: Vector
    y: Vector

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        read_only(self.x)
        read_only(self.y)


@dataclass(frozen=True, slots=True, kw_only=True)
class FigureResult:
    """One figure of the paper, drawn anew.

    Attributes
    ----------
    name, title
        Its number, and what it shows.
    claim
        What the paper reads from its own.
    found
        What ours shows, with the figures of this run.
    x_label, y_label
        Of the axes, with units.
    log_x, log_y
        Whether an axis is logarithmic.
    series
        The lines.
    """

    name: str
    title: str
    claim: str
    found: str
    x_label: str
    y_label: str
    log_x: bool = False
    log_y: bool = False
    series: tuple[Series, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """A claim of the paper or a question it leaves, the verdict, and why, with figures."""

    claim: str
    verdict: Verdict
    text: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Reproduction:
    """Everything that one run of the reproduction found out.

    Attributes
    ----------
    seed
        Start of all random numbers.
    logs, repeats
        Simulated logs of each class, and runs of each optimiser in paper mode on each of their ten
        groups.
    remarks
        What a reader must know before quoting a figure.
    """

    seed: int
    logs: int
    repeats: int
    table1: tuple[TableRow, ...]
    acceptance: tuple[AcceptanceRow, ...]
    figures: tuple[FigureResult, ...]
    findings: tuple[Finding, ...]
    remarks: tuple[str, ...]

    @property
    def failures(self) -> tuple[AcceptanceRow, ...]:
        """Rows outside their band."""
        return tuple(row for row in self.acceptance if row.holds is False)


def in_words(value: float, unit: Unit) -> str:
    """Return a figure as text: a share in per cent, an infinite one as never."""
    if not math.isfinite(value):
        return "never"
    if unit == "share":
        return f"{100.0 * value:.3g} %"
    return f"{value:.4g} {unit}".rstrip()
