"""What ``smooth`` prints."""

from dataclasses import asdict, dataclass
from pathlib import Path

import click
import numpy as np

from hostkit.cli.inputs import say
from hostkit.recordings import Recording
from hostkit.smoothing import Provenance, SmoothedRecording, SmoothingScore, Trained
from hostkit.units import DEG_PER_RAD


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SmoothedFile:
    """A recording that was smoothed and written.

    Attributes
    ----------
    is_reference
        Whether the smoothed tilt was written as the reference.
    """

    source: Path
    target: Path
    recording: Recording
    smoothed: SmoothedRecording
    is_reference: bool
    score: SmoothingScore | None


def say_pieces(path: Path, recording: Recording, smoothed: SmoothedRecording) -> None:
    """Say what is unusual about the times and what could not be smoothed."""
    if smoothed.resampled:
        say(f"{path}: times are uneven; readings were interpolated at even ones")
    if smoothed.doubted_s > 0.0:
        say(f"{path}: {smoothed.doubted_s:.3g} s of rates are clipped or missing: not believed")
    for rows in smoothed.short:
        begin_s, end_s = recording.time_s[rows.start], recording.time_s[rows.stop - 1]
        say(f"{path}: {begin_s:.3f} to {end_s:.3f} s is too short between gaps: left without tilt")
    for piece in smoothed.pieces:
        settings = piece.smoothed.settings
        if piece.smoothed.compared:
            say(
                f"{path}: settings {settings.gyro_noise_density_rad_s_rthz:g} rad/s/rtHz, "
                f"{settings.accel_noise_density_m_s2_rthz:g} m/s^2/rtHz, "
                f"gyro scale {settings.gyro_scale:g}, of {piece.smoothed.compared} compared"
            )


def smoothed_document(files: tuple[SmoothedFile, ...]) -> dict[str, object]:
    """Return ``hostkit.smooth/1``."""
    figures = _headlines(files)
    return {
        "schema": "hostkit.smooth/1",
        "mean_rmse_deg": float(np.mean(figures)) if figures else None,
        "recordings": [_document(file) for file in files],
    }


def _headlines(files: tuple[SmoothedFile, ...]) -> list[float]:
    return [f.score.headline_rad() * DEG_PER_RAD for f in files if f.score is not None]


def _document(file: SmoothedFile) -> dict[str, object]:
    found = file.score
    return {
        "path": str(file.source),
        "output": str(file.target),
        "samples": len(file.recording),
        "written_as": "reference" if file.is_reference else "smooth",
        "scored_samples": 0 if found is None else found.samples,
        "rmse_deg": None
        if found is None
        else {
            "roll": _deg(found.roll_rad),
            "pitch": _deg(found.pitch_rad),
            "inclination": _deg(found.inclination_rad),
        },
        "resampled": file.smoothed.resampled,
        "doubted_s": file.smoothed.doubted_s,
        "unsmoothed_samples": int(np.isnan(file.smoothed.up[:, 0]).sum()),
        "pieces": [
            {
                "samples": piece.rows.stop - piece.rows.start,
                "settings": asdict(piece.smoothed.settings),
                "compared": piece.smoothed.compared,
                "gyro_bias_deg_s": _mean_bias_deg_s(piece.smoothed.gyro_bias_rad_s),
                "gyro_scale": piece.smoothed.gyro_scale.tolist(),
                "accel_offset_m_s2": piece.smoothed.accel_offset_m_s2.tolist(),
                "accel_scale": piece.smoothed.accel_scale.tolist(),
            }
            for piece in file.smoothed.pieces
        ],
    }


def _mean_bias_deg_s(bias_rad_s: np.typing.NDArray[np.float64]) -> list[float]:
    return [float(value) for value in bias_rad_s.mean(axis=0) * DEG_PER_RAD]


def _deg(angle_rad: float | None) -> float | None:
    return None if angle_rad is None else angle_rad * DEG_PER_RAD


def show_smoothed(files: tuple[SmoothedFile, ...]) -> None:
    """Print a line for each recording, and the mean error where there is one."""
    for file in files:
        end = "smoothed tilt written as its reference"
        if file.score is not None:
            figure = file.score.headline_rad() * DEG_PER_RAD
            end = f"RMSE {figure:.4f} deg against its reference, over {file.score.samples} samples"
        elif not file.is_reference:
            end = "no valid sample has a reference, so there is no error to show"
        click.echo(f"{file.target}: {len(file.recording)} samples; {end}")
    figures = _headlines(files)
    if len(figures) > 1:
        click.echo(f"mean RMSE {np.mean(figures):.4f} deg, worst {np.max(figures):.4f} deg")


def trained_document(trained: Trained, found: Provenance, output: Path) -> dict[str, object]:
    """Return ``hostkit.smooth.train/1``."""
    return {
        "schema": "hostkit.smooth.train/1",
        "settings_file": str(output),
        "settings": asdict(trained.settings),
        "rmse_deg": found.rmse_deg,
        "held_out_rmse_deg": found.held_out_rmse_deg,
        "held_out_each_rmse_deg": [rms * DEG_PER_RAD for rms in trained.held_out_rad],
        "folds": trained.folds,
        "evaluations": trained.evaluations,
        "seed": found.seed,
    }


def show_trained(trained: Trained, output: Path) -> None:
    """Print the settings and their errors."""
    held_out = "one recording: nothing could be left out"
    if trained.held_out_rad:
        mean = np.mean(trained.held_out_rad) * DEG_PER_RAD
        held_out = f"{mean:.4f} deg on recordings left out ({trained.folds} folds)"
    click.echo(
        f"{output}: RMSE {trained.rmse_rad * DEG_PER_RAD:.4f} deg on the training recordings, "
        f"{held_out}; {trained.evaluations} evaluations"
    )
    for name, value in asdict(trained.settings).items():
        click.echo(f"  {name:<32} {value:g}")
