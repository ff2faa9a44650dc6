"""The figures of the reproduction, each as SVG text."""

import numpy as np

from hostkit.report.canvas import BLUE, GREEN, GREY, ORANGE, new_figure, svg_text
from hostkit.reproduction import FigureResult

COLOURS = {
    "truth": GREY,
    "accelerometer": ORANGE,
    "gyroscope": BLUE,
    "filter": GREEN,
}
OTHERS = (BLUE, ORANGE, GREEN)
FEW_POINTS = 40
"""Up to so many points of a line are marked."""


def draw(result: FigureResult) -> str:
    """Return the lines of one figure in its axes."""
    figure, axes, mpl = new_figure(height=3.4)
    colours = iter(OTHERS)
    for series in result.series:
        y = np.where(series.y > 0.0, series.y, np.nan) if result.log_y else series.y
        axes.plot(
            series.x,
            y,
            label=series.label,
            color=COLOURS.get(series.label) or next(colours),
            marker="." if len(y) <= FEW_POINTS else None,
            lw=3.0 if series.label == "truth" else None,
            zorder=1 if series.label == "truth" else 2,
        )
    axes.set(xlabel=result.x_label, ylabel=result.y_label)
    axes.set_xscale("log" if result.log_x else "linear")
    axes.set_yscale("log" if result.log_y else "linear")
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.98), ncols=len(result.series))
    return svg_text(figure, mpl)
