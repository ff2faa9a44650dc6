"""The figures of the reports, each as SVG text."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hostkit.attitude import wrap_rad
from hostkit.filters import FILTERS
from hostkit.records import FilterDesign
from hostkit.report.canvas import BLUE, GREEN, GREY, INK, ORANGE, new_figure, svg_text, thinning
from hostkit.tuning import Evaluation, Interval, Profile
from hostkit.units import DEG_PER_RAD

Vector = NDArray[np.float64]

LOWEST_HZ = 1e-4
"""Where frequency responses begin."""


def convergence(history_rad: Vector) -> str:
    """How far the swarm was from its end, over its iterations."""
    figure, axes, mpl = new_figure()
    excess_deg = (history_rad - history_rad[-1]) * DEG_PER_RAD
    excess_deg = np.where(excess_deg > 0.0, excess_deg, np.nan)
    axes.semilogy(excess_deg, color=BLUE, drawstyle="steps-post", marker=".")
    axes.set(xlabel="iteration", ylabel="excess cost, deg", xlim=(0, len(history_rad) - 1))
    final_deg = history_rad[-1] * DEG_PER_RAD
    axes.set_title(f"final cost {final_deg:.6g} deg", loc="right", fontsize=10)
    return svg_text(figure, mpl)


def fit(evaluation: Evaluation, names: Sequence[str]) -> str:
    """Angles and reference over time, and the residual below, for each axis of the design."""
    count = len(names)
    figure, axes, mpl = new_figure(rows=2 * count, height=1.2 + 2.2 * count)
    thin = thinning(evaluation.samples)
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
    return svg_text(figure, mpl)


def residual_histogram(evaluations: Sequence[Evaluation], names: Sequence[str]) -> str:
    """Distribution of the error over all recordings."""
    figure, axes, mpl = new_figure()
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
    return svg_text(figure, mpl)


def frequency_response(design: FilterDesign) -> str:
    """Bode diagram: how the filter weighs its two sensors over frequency, with the crossover."""
    figure, axes, mpl = new_figure(rows=2, height=4.6)
    magnitude, phase = axes
    frequency_hz = np.geomspace(LOWEST_HZ, 0.5 * design.rate_hz, 2000)
    force, rate = FILTERS[design.filter].response(design, frequency_hz)
    for weight, colour, name in ((force, ORANGE, "specific force"), (rate, BLUE, "angular rate")):
        magnitude.semilogx(frequency_hz, 20 * np.log10(np.abs(weight)), color=colour, label=name)
        phase.semilogx(frequency_hz, np.unwrap(np.angle(weight)) * DEG_PER_RAD, color=colour)
    stronger = np.abs(rate) > np.abs(force)
    if stronger.any():
        crossover = frequency_hz[int(np.argmax(stronger))]
        for panel in axes:
            panel.axvline(crossover, color=GREY, ls="--")
        magnitude.annotate(f" {crossover:.3g} Hz", (crossover, -38), color=INK)
    magnitude.set(ylabel="weight, dB", ylim=(-42, 6))
    magnitude.legend(loc="lower left")
    phase.set(xlabel="frequency, Hz", ylabel="phase, deg")
    return svg_text(figure, mpl)


def cost_profiles(profiles: Sequence[Profile], intervals: Sequence[Interval]) -> str:
    """Cost along each parameter, with the tuned value and its interval."""
    figure, axes, mpl = new_figure(
        rows=len(profiles), height=0.6 + 1.9 * len(profiles), shared=False
    )
    for panel, profile, interval in zip(np.atleast_1d(axes), profiles, intervals, strict=True):
        dimension = profile.dimension
        scale, unit = dimension.shown(1.0)
        draw = panel.semilogx if dimension.is_log else panel.plot
        draw(profile.values * scale, profile.cost_rad * DEG_PER_RAD, color=BLUE)
        panel.axvline(interval.value * scale, color=ORANGE)
        if interval.low is not None and interval.high is not None:
            low, high = interval.low * scale, interval.high * scale
            panel.axvspan(low, high, color=ORANGE, alpha=0.15, lw=0)
        panel.set(ylabel="cost, deg", xlabel=f"{dimension.label}{f', {unit}' if unit else ''}")
    return svg_text(figure, mpl)


def device_residuals(
    time_s: Vector, residuals_rad: Sequence[tuple[str, Vector]], bound_rad: float
) -> str:
    """Device minus float model over time, one panel per device, with the stated bound."""
    figure, axes, mpl = new_figure(rows=len(residuals_rad), height=0.6 + 1.5 * len(residuals_rad))
    axes = np.atleast_1d(axes)
    for panel, (name, residual) in zip(axes, residuals_rad, strict=True):
        thin = thinning(len(residual))
        values = residual[thin] * DEG_PER_RAD * 1e6
        panel.plot(time_s[: len(residual)][thin], values, color=GREEN, lw=0.8)
        panel.set_ylabel("1e-6 deg")
        panel.set_title(name, loc="left", fontsize=10)
    axes[-1].set_xlabel(f"time, s   (stated bound: {bound_rad * DEG_PER_RAD * 1e6:.0f}e-6 deg)")
    return svg_text(figure, mpl)
