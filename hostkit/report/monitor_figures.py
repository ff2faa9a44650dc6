"""The figures of the monitor's report, each as SVG text."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hostkit.monitor.result import Overlay
from hostkit.report.canvas import BLUE, GREY, ORANGE, new_figure, svg_text
from hostkit.units import DEG_PER_RAD
from hostkit.validation import Histogram

Vector = NDArray[np.float64]


def overlay_figure(overlay: Overlay, names: Sequence[str]) -> str:
    """Device over model, and the residual below, for each axis of the design."""
    count = len(names)
    figure, axes, mpl = new_figure(rows=2 * count, height=1.2 + 2.4 * count)
    time_s = _broken(overlay.time_s[:, None], overlay)[:, 0]
    curves = (overlay.device_rad, overlay.model_rad, overlay.residual_rad)
    device, model, residual = (_broken(curve * DEG_PER_RAD, overlay) for curve in curves)
    for i, name in enumerate(names):
        above, below = axes[2 * i], axes[2 * i + 1]
        above.plot(time_s, model[:, i], color=GREY, lw=3, label="float model")
        above.plot(time_s, device[:, i], color=BLUE, label="device")
        above.set_ylabel(f"{name}, deg")
        above.legend(loc="lower right", bbox_to_anchor=(1.0, 0.98), ncols=2)
        below.plot(time_s, residual[:, i], color=ORANGE, lw=0.8)
        below.set_ylabel("residual, deg")
    axes[-1].set_xlabel("device time, s")
    return svg_text(figure, mpl)


def _broken(rows: Vector, overlay: Overlay) -> Vector:
    """Return rows with one of NaN before each point that does not follow the one before it."""
    places = np.flatnonzero(overlay.begins)
    return np.insert(rows, places[places > 0], np.nan, axis=0)


def residual_sizes(
    histograms: Sequence[Histogram], names: Sequence[str], limit_deg: float | None
) -> str:
    """Spread of the size of the residual over classes of equal ratio, and the limit of its RMS."""
    figure, axes, mpl = new_figure()
    for histogram, name, colour in zip(histograms, names, (BLUE, ORANGE), strict=False):
        edges = histogram.edges * DEG_PER_RAD
        axes.stairs(histogram.counts, edges, fill=True, color=colour, alpha=0.6, label=name)
    if limit_deg:
        axes.axvline(limit_deg, color=GREY, ls="--", label="limit of the rms")
    axes.set(xlabel="size of the residual, deg", ylabel="samples", xscale="log")
    axes.legend()
    return svg_text(figure, mpl)


def jitter_sizes(histogram: Histogram) -> str:
    """Spread of the jitter of arrival over classes of equal ratio."""
    figure, axes, mpl = new_figure()
    axes.stairs(histogram.counts, histogram.edges * 1e3, fill=True, color=BLUE)
    axes.set(xlabel="jitter, ms", ylabel="arrivals", xscale="log")
    return svg_text(figure, mpl)
