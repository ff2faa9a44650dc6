"""The subcommand ``evaluate``: a design scored on recordings."""

import math
from pathlib import Path

import click

from hostkit.cli.inputs import DESIGN, JSON, RECORDINGS, read_design, read_recording, say
from hostkit.cli.output import emit_json
from hostkit.design_file import digest
from hostkit.tuning import QUANTITIES, Evaluation, mean_rms_rad
from hostkit.tuning import evaluate as run_evaluation
from hostkit.tuning.evaluation import Quantity


@click.command("evaluate")
@DESIGN
@RECORDINGS
@JSON
def evaluate(design_file: Path, recording_files: tuple[Path, ...], as_json: bool) -> None:
    """Score DESIGN on recordings: the angles its device would give, against the reference.

    Residuals are wrap-safe and over valid samples with a reference; inclination is the angle
    between estimated and true up direction.

    \b
    Example:
      hostkit evaluate design.json held-out-1.csv held-out-2.csv
    """
    design = read_design(design_file)
    evaluations = []
    for path in recording_files:
        evaluation = run_evaluation(design, read_recording(path))
        if evaluation.clipped_samples:
            say(
                f"{path}: {evaluation.clipped_samples} of {evaluation.samples} samples are beyond "
                f"the design's ranges; tune with a wider --gyro-range or --accel-range"
            )
        evaluations.append(evaluation)
    if as_json:
        documents = [
            _document(path, e) for path, e in zip(recording_files, evaluations, strict=True)
        ]
        emit_json(
            {
                "schema": "hostkit.evaluate/1",
                "digest": digest(design),
                "mean_rmse_deg": {q: _mean_deg(evaluations, q) for q in QUANTITIES},
                "recordings": documents,
            }
        )
    else:
        _show(evaluations)


def _mean_deg(evaluations: list[Evaluation], quantity: Quantity) -> float | None:
    mean = mean_rms_rad(tuple(evaluations), quantity)
    return None if mean is None else math.degrees(mean)


def _document(path: Path, evaluation: Evaluation) -> dict[str, object]:
    scores = {q: evaluation.score(q) for q in QUANTITIES}
    return {
        "path": str(path),
        "samples": evaluation.samples,
        "scored_samples": evaluation.scored_samples,
        "rmse_deg": {q: s and math.degrees(s.rms_rad) for q, s in scores.items()},
        "max_deg": {q: s and math.degrees(s.max_rad) for q, s in scores.items()},
        "integer_vs_float_max_deg": math.degrees(evaluation.integer_vs_float_max_rad),
        "clipped_samples": evaluation.clipped_samples,
    }


def _show(evaluations: list[Evaluation]) -> None:
    shown = [q for q in QUANTITIES if any(e.score(q) for e in evaluations)]
    width = max(len(e.recording) for e in evaluations)
    header = "".join(f"{q + ' rms':>17}{'max':>9}" for q in shown)
    click.echo(f"{'recording':<{width}}{'samples':>9}{header}{'int-float':>11}  (deg)")
    for e in evaluations:
        scores = [e.score(q) for q in shown]
        columns = "".join(
            f"{math.degrees(s.rms_rad):17.4f}{math.degrees(s.max_rad):9.3f}" if s else f"{'-':>26}"
            for s in scores
        )
        difference = math.degrees(e.integer_vs_float_max_rad)
        click.echo(f"{e.recording:<{width}}{e.samples:9d}{columns}{difference:11.6f}")
    means = "".join(
        f"{mean:17.4f}{'':9}" for q in shown if (mean := _mean_deg(evaluations, q)) is not None
    )
    if means:
        click.echo(f"{'mean':<{width}}{'':9}{means}")
    else:
        click.echo("no recording has a reference, so there is no error to show")
