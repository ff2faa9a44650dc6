"""The figures of the reports, each as SVG text."""

import io
import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hostkit.attitude import wrap_rad
from hostkit.errors import ToolMissingError
from hostkit.filters.complementary import crossover_hz, tau_from_eta
from hostkit.tuning import Evaluation
from hostkit.units import DEG_PER_RAD

Vector = NDArray[np.float64]

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


def _figure(rows: int = 1, height: float = 3.0) -> tuple[Any, Any, Any]:
    """Return matplotlib's pyplot-free figure, its axes and the canvas class.

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
        return figure, figure.subplots(rows, 1, sharex=True), mpl


def _svg(figure: Any, mpl: Any) -> str:
    buffer = io.StringIO()
    with mpl.rc_context(STYLE):
        figure.savefig(buffer, format="svg", metadata={"Date": None, "Creator": "hostkit"})
    text = buffer.getvalue()
    return text[text.index("<svg") :]


def _thin(samples: int) -> slice:
    return slice(None, None, max(1, math.ceil(samples / MOST_POINTS)))


def convergence(history_rad: Vector) -> str:
    """How far the swarm was from its end, over its iterations."""
    figure, axes, mpl = _figure()
    excess_deg = (history_rad - history_rad[-1]) * DEG_PER_RAD
    excess_deg = np.where(excess_deg > 0.0, excess_deg, np.nan)
    axes.semilogy(excess_deg, color=BLUE, drawstyle="steps-post", marker=".")
    axes.set(xlabel="iteration", ylabel="excess cost, deg", xlim=(0, len(history_rad) - 1))
    final_deg = history_rad[-1] * DEG_PER_RAD
    axes.set_title(f"final cost {final_deg:.6g} deg", loc="right", fontsize=10)
    return _svg(figure, mpl)


def fit(evaluation: Evaluation, names: Sequence[str]) -> str:
    """Angles and reference over time, and the residual below, for each axis of the design."""
    count = len(names)
    figure, axes, mpl = _figure(rows=2 * count, height=1.2 + 2.2 * count)
    thin = _thin(evaluation.samples)
    time_s = evaluation.time_s[thin] - evaluation.time_s[0]
    for i, name in enumerate(names):
        angle = evaluation.angle_rad[:, i] * DEG_PER_RAD
        above, below = axes[2 * i], axes[2 * i + 1]
        if evaluation.reference_rad is not None:
            reference = evaluation.reference_rad[:, i]
            residual = wrap_rad(evaluation.angle_rad[:, i] - reference) * DEG_PER_RAD
            residual = np.where(evaluation.scored, residual, np.nan)
            above.plot(time_s, reference[thin] * DEG_PER_RAD, color=GREY, lw=3, label="reference")
            below.plot(time_s, residual[thin], color=ORANGE)
        above.plot(time_s, angle[thin], color=BLUE, label="filter")
        above.set_ylabel(f"{name}, deg")
        above.legend(loc="lower right", bbox_to_anchor=(1.0, 0.98), ncols=2)
        below.set_ylabel("error, deg")
    axes[-1].set_xlabel("time, s")
    return _svg(figure, mpl)


def residual_histogram(evaluations: Sequence[Evaluation], names: Sequence[str]) -> str:
    """Distribution of the error over all recordings."""
    figure, axes, mpl = _figure()
    for i, (name, colour) in enumerate(zip(names, (BLUE, ORANGE), strict=False)):
        parts = [
            wrap_rad(e.angle_rad[e.scored, i] - e.reference_rad[e.scored, i]) * DEG_PER_RAD
            for e in evaluations
            if e.reference_rad is not None
        ]
        if parts:
            axes.hist(np.concatenate(parts), bins=80, color=colour, alpha=0.65, label=name)
    axes.set(xlabel="error, deg", ylabel="samples")
    axes.legend()
    return _svg(figure, mpl)


def frequency_response(eta: float, period_s: float) -> str:
    """How the filter weighs the two sensors over frequency, with the crossover."""
    figure, axes, mpl = _figure()
    frequency_hz = np.geomspace(1e-3 / tau_from_eta(eta, period_s), 0.5 / period_s, 400)
    delay = np.exp(-2j * np.pi * frequency_hz * period_s)
    low = (1.0 - eta) / (1.0 - eta * delay)
    high = eta * (1.0 - delay) / (1.0 - eta * delay)
    crossover = crossover_hz(eta, period_s)
    axes.semilogx(frequency_hz, 20 * np.log10(np.abs(low)), color=ORANGE, label="specific force")
    axes.semilogx(frequency_hz, 20 * np.log10(np.abs(high)), color=BLUE, label="angular rate")
    axes.axvline(crossover, color=GREY, ls="--")
    axes.annotate(f" {crossover:.3g} Hz", (crossover, -38), color=INK)
    axes.set(xlabel="frequency, Hz", ylabel="weight, dB", ylim=(-42, 3))
    axes.legend(loc="lower left")
    return _svg(figure, mpl)


def device_residuals(
    time_s: Vector, residuals_rad: Sequence[tuple[str, Vector]], bound_rad: float
) -> str:
    """Device minus float model over time, one panel per device, with the stated bound."""
    figure, axes, mpl = _figure(rows=len(residuals_rad), height=0.6 + 1.5 * len(residuals_rad))
    axes = np.atleast_1d(axes)
    for panel, (name, residual) in zip(axes, residuals_rad, strict=True):
        thin = _thin(len(residual))
        values = residual[thin] * DEG_PER_RAD * 1e6
        panel.plot(time_s[: len(residual)][thin], values, color=GREEN, lw=0.8)
        panel.set_ylabel("1e-6 deg")
        panel.set_title(name, loc="left", fontsize=10)
    axes[-1].set_xlabel(f"time, s   (stated bound: {bound_rad * DEG_PER_RAD * 1e6:.0f}e-6 deg)")
    return _svg(figure, mpl)
