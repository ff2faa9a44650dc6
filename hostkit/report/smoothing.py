"""The report of smoothed recordings."""

from pathlib import Path

import numpy as np

from hostkit.attitude import inclination_rad, pitch_from_up, roll_from_up
from hostkit.recordings import Recording
from hostkit.report.canvas import BLUE, GREEN, ORANGE, new_figure, svg_text, thinning
from hostkit.report.page import Fact, Page, Plot, Table, write_page
from hostkit.smoothing import SmoothedRecording, SmoothingScore, measured_reference
from hostkit.units import DEG_PER_RAD


def write_smoothing_report(
    recordings: tuple[Recording, ...],
    smoothed: tuple[SmoothedRecording, ...],
    scores: tuple[SmoothingScore | None, ...],
    path: Path,
) -> None:
    """Write the report of smoothed recordings as one HTML file.

    Raises
    ------
    ToolMissingError
        If matplotlib is not installed.
    HostkitError
        If the file cannot be written.
    """
    pairs = tuple(zip(recordings, smoothed, strict=True))
    page = Page(
        title="Smoothing",
        subtitle=", ".join(recording.name for recording in recordings),
        facts=_facts(scores, smoothed),
        sections=(
            _errors(recordings, scores),
            _constants(pairs),
            *(plot for recording, found in pairs for plot in _plots(recording, found)),
        ),
        provenance=tuple(
            (f"recording {r.name}", f"{len(r)} samples, sha256 {r.sha256 or 'not from a file'}")
            for r in recordings
        ),
    )
    write_page(page, path)


def _facts(
    scores: tuple[SmoothingScore | None, ...], smoothed: tuple[SmoothedRecording, ...]
) -> tuple[Fact, ...]:
    figures = [score.headline_rad() * DEG_PER_RAD for score in scores if score is not None]
    error = f"{np.mean(figures):.3f} deg" if figures else "not known"
    note = f"RMSE, mean of {len(figures)} with a reference" if figures else "no reference"
    doubted_s = sum(found.doubted_s for found in smoothed)
    return (
        Fact(label="recordings", value=str(len(smoothed))),
        Fact(label="error", value=error, note=note),
        Fact(label="rates not believed", value=f"{doubted_s:.3g} s", note="clipped or missing"),
    )


def _errors(recordings: tuple[Recording, ...], scores: tuple[SmoothingScore | None, ...]) -> Table:
    def row(recording: Recording, score: SmoothingScore | None) -> tuple[str, ...]:
        if score is None:
            return recording.name, str(len(recording)), "-", "-", "-"
        each = (score.roll_rad, score.pitch_rad, score.inclination_rad)
        shown = ("-" if rad is None else f"{rad * DEG_PER_RAD:.3f}" for rad in each)
        return recording.name, str(len(recording)), *shown

    return Table(
        title="Errors",
        header=("recording", "samples", "roll, deg", "pitch, deg", "inclination, deg"),
        rows=tuple(row(r, s) for r, s in zip(recordings, scores, strict=True)),
        note="RMSE against the measured reference, over valid samples.",
    )


def _constants(pairs: tuple[tuple[Recording, SmoothedRecording], ...]) -> Table:
    rows = tuple(
        (
            recording.name,
            _three(piece.smoothed.gyro_bias_rad_s.mean(axis=0) * DEG_PER_RAD, 3),
            _three(piece.smoothed.gyro_scale * 100.0, 2),
            f"{piece.smoothed.settings.gyro_noise_density_rad_s_rthz:g}",
            f"{piece.smoothed.settings.accel_noise_density_m_s2_rthz:g}",
            f"{piece.smoothed.settings.gyro_scale:g}",
        )
        for recording, found in pairs
        for piece in found.pieces
    )
    return Table(
        title="What was found of the sensor, and the settings",
        header=(
            "recording",
            "gyro bias x y z, deg/s",
            "gyro scale x y z, %",
            "rate noise, rad/s/rtHz",
            "force noise, m/s^2/rtHz",
            "scale left free",
        ),
        rows=rows,
        note="A row for each piece between gaps; the bias is the mean over the piece.",
    )


def _three(values: np.typing.NDArray[np.float64], digits: int) -> str:
    return " ".join(f"{value:+.{digits}f}" for value in values)


def _plots(recording: Recording, found: SmoothedRecording) -> tuple[Plot, ...]:
    reference = measured_reference(recording)
    thin = thinning(len(recording))
    time_s = recording.time_s[thin] - recording.time_s[0]
    figure, axes, mpl = new_figure(rows=2, height=4.4)
    for panel, angle, label in zip(
        axes, (roll_from_up, pitch_from_up), ("roll", "pitch"), strict=True
    ):
        if reference is not None:
            shown = angle(reference[thin]) * DEG_PER_RAD
            panel.plot(time_s, shown, color=ORANGE, label="reference")
        panel.plot(
            time_s, angle(found.up[thin]) * DEG_PER_RAD, color=BLUE, lw=0.8, label="smoothed"
        )
        panel.set_ylabel(f"{label}, deg")
    axes[0].legend()
    axes[-1].set_xlabel("time, s")
    tilt = Plot(
        title=f"{recording.name}: tilt",
        caption="Roll and pitch in sensor axes.",
        svg=svg_text(figure, mpl),
    )
    if reference is None:
        return (tilt,)
    figure, panel, mpl = new_figure()
    error = inclination_rad(found.up[thin], reference[thin]) * DEG_PER_RAD
    panel.plot(time_s, np.where(recording.valid[thin], error, np.nan), color=GREEN, lw=0.8)
    panel.set(xlabel="time, s", ylabel="inclination error, deg")
    caption = "Angle to the measured up direction, where it counts."
    return tilt, Plot(title=f"{recording.name}: error", caption=caption, svg=svg_text(figure, mpl))
