"""The figures of the diagnosis report, each as SVG text."""

from typing import Any

import numpy as np

from hostkit.diagnosis.allan import AllanCurve
from hostkit.diagnosis.force import VIBRATION_FROM_HZ, ForceLevel, Spectrum
from hostkit.diagnosis.noise import SensorNoise
from hostkit.diagnosis.rest import Rest
from hostkit.diagnosis.timing import Timing
from hostkit.recordings import Recording
from hostkit.report.canvas import BLUE, GREEN, GREY, ORANGE, new_figure, svg_text, thinning
from hostkit.units import DEG_PER_RAD, STANDARD_GRAVITY_M_S2

COLOURS = (BLUE, ORANGE, GREEN)


def step_histogram(timing: Timing) -> str:
    """Time steps that are no gaps, on a logarithmic scale of counts."""
    figure, axes, mpl = new_figure()
    axes.stairs(np.maximum(timing.counts, 0.5), 1e3 * timing.edges_s, fill=True, color=BLUE)
    axes.set(
        xlabel="time step, ms", ylabel="samples", yscale="log", ylim=(0.5, 2.0 * _most(timing))
    )
    return svg_text(figure, mpl)


def _most(timing: Timing) -> float:
    return float(timing.counts.max(initial=1))


def rest_over_time(recording: Recording, rest: Rest) -> str:
    """Magnitudes of rate and force over time, with the stretches at rest shaded."""
    figure, axes, mpl = new_figure(rows=2, height=4.4)
    thin = thinning(len(recording))
    start_s = float(recording.time_s[0])
    time_s = recording.time_s[thin] - start_s
    rate = np.linalg.norm(recording.angular_rate_rad_s[thin], axis=1) * DEG_PER_RAD
    force = np.linalg.norm(recording.specific_force_m_s2[thin], axis=1) / STANDARD_GRAVITY_M_S2
    for panel, values, label in zip(axes, (rate, force), ("rate, deg/s", "force, g"), strict=True):
        for stretch in rest.stretches:
            panel.axvspan(
                stretch.begin_s - start_s, stretch.end_s - start_s, color=GREY, alpha=0.35, lw=0
            )
        panel.plot(time_s, values, color=BLUE, lw=0.8)
        panel.set_ylabel(label)
    axes[-1].set_xlabel("time, s   (grey: at rest)")
    return svg_text(figure, mpl)


def force_spectrum(spectrum: Spectrum) -> str:
    """Amplitude density of the specific force, and where vibration begins."""
    figure, axes, mpl = new_figure()
    density = np.sqrt(spectrum.density[1:])
    for axis, colour in enumerate(COLOURS):
        shown = np.where(density[:, axis] > 0.0, density[:, axis], np.nan)
        axes.plot(spectrum.frequency_hz[1:], shown, color=colour, label="xyz"[axis])
    axes.axvline(VIBRATION_FROM_HZ, color=GREY, ls="--")
    scale = "log" if bool((density > 0.0).any()) else "linear"
    axes.set(xlabel="frequency, Hz", ylabel="m/s^2 per root hertz", xscale="log", yscale=scale)
    axes.legend()
    return svg_text(figure, mpl)


def force_deviation(force: ForceLevel) -> str:
    """How far the magnitude of the specific force is from 1 g."""
    figure, axes, mpl = new_figure()
    axes.stairs(np.maximum(force.counts, 0.5), force.edges_g, fill=True, color=BLUE)
    most = float(force.counts.max())
    axes.set(xlabel="|f| - 1 g, g", ylabel="samples", yscale="log", ylim=(0.5, 2.0 * most))
    return svg_text(figure, mpl)


def allan_deviation(noise: SensorNoise) -> str:
    """Allan deviations of gyroscope and accelerometer."""
    figure, axes, mpl = new_figure(rows=2, height=5.4)
    _curve(axes[0], noise.gyro, DEG_PER_RAD, "gyro, deg/s")
    _curve(axes[1], noise.accel, 1.0, "accel, m/s^2")
    axes[0].legend()
    axes[1].set_xlabel("averaging time, s")
    return svg_text(figure, mpl)


def _curve(panel: Any, curve: AllanCurve, per_unit: float, label: str) -> None:
    """Draw the axes of one element; a signal without any noise has no point on these scales."""
    drawn = False
    for axis, colour in enumerate(COLOURS):
        values = curve.deviation[:, axis] * per_unit
        shown = values > 0.0
        drawn |= bool(shown.any())
        panel.plot(curve.tau_s[shown], values[shown], color=colour, label="xyz"[axis], marker=".")
    scale = "log" if drawn else "linear"
    panel.set(ylabel=label, xscale=scale, yscale=scale)
