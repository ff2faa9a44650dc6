"""What the figures of all reports are drawn on: style, canvas, and the way to SVG text."""

import io
import math
from typing import Any

from hostkit.errors import ToolMissingError

MOST_POINTS = 3000
"""Points of a line; more do not show and make the file large."""

INK = "#1f2933"
BLUE, ORANGE, GREEN, GREY = "#1769aa", "#d9730d", "#2e7d4f", "#9aa5b1"
STYLE: Any = {
    "svg.fonttype": "none",
    "svg.hashsalt": "hostkit",
    "font.family": "sans-serif",
    "font.size": 10,
    "text.color": INK,
    "axes.edgecolor": GREY,
    "axes.labelcolor": INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#e4e7eb",
    "xtick.color": INK,
    "ytick.color": INK,
    "legend.frameon": False,
    "lines.linewidth": 1.4,
    "figure.constrained_layout.use": True,
}


def new_figure(rows: int = 1, height: float = 3.0, *, shared: bool = True) -> tuple[Any, Any, Any]:
    """Return matplotlib's pyplot-free figure, its axes and the canvas class.

    Parameters
    ----------
    rows, height
        Panels below each other, and the height of all, inches.
    shared
        Whether the panels have one x axis.

    Raises
    ------
    ToolMissingError
        If matplotlib is not installed.
    """
    try:
        import matplotlib as mpl
        from matplotlib.backends.backend_svg import FigureCanvasSVG
        from matplotlib.figure import Figure
    except ImportError as error:
        raise ToolMissingError(
            "a report needs matplotlib: pip install 'hostkit[report]'"
        ) from error
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(8.4, height))
        FigureCanvasSVG(figure)
        return figure, figure.subplots(rows, 1, sharex=shared), mpl


def svg_text(figure: Any, mpl: Any) -> str:
    """Return a figure as SVG text, the same bytes whenever it is drawn."""
    buffer = io.StringIO()
    with mpl.rc_context(STYLE):
        figure.savefig(buffer, format="svg", metadata={"Date": None, "Creator": "hostkit"})
    text = buffer.getvalue()
    return text[text.index("<svg") :]


def thinning(samples: int) -> slice:
    """Return which of so many samples to draw."""
    return slice(None, None, max(1, math.ceil(samples / MOST_POINTS)))
