"""What ``tune`` says: on the screen and as a document."""

import math
from pathlib import Path

import click

from hostkit.design_file import digest
from hostkit.filters import FILTERS
from hostkit.tuning import Interval, TuningResult
from hostkit.units import DEG_PER_RAD


def tuning_document(result: TuningResult, output: Path) -> dict[str, object]:
    """Return the result of a tuning as the document ``hostkit.tune/1``."""
    design, held_out = result.design, result.held_out
    assert design.tuning is not None
    return {
        "schema": "hostkit.tune/1",
        "design": str(output),
        "digest": digest(design),
        "filter": design.filter,
        "parameters": {p.name: p.value for p in design.parameters},
        **{fact.name: fact.value for fact in FILTERS[design.filter].facts(design)},
        "rate_hz": design.rate_hz,
        "rmse_deg": result.rms_rad * DEG_PER_RAD,
        "held_out": None
        if held_out is None
        else {
            "unit": held_out.unit,
            "folds": held_out.folds,
            "rmse_deg": held_out.rms_rad * DEG_PER_RAD,
            "each_rmse_deg": [
                rms * DEG_PER_RAD if math.isfinite(rms) else None for rms in held_out.each_rad
            ],
        },
        "intervals": [_interval_document(interval) for interval in result.intervals],
        "remarks": list(result.remarks),
        "evaluations": result.swarm.evaluations,
        "optimiser": design.tuning.optimiser,
        "seed": design.tuning.seed,
        "at_bound": bool(result.swarm.at_bound.any()),
        "history_rad": [float(cost) for cost in result.swarm.history],
    }


def _interval_document(interval: Interval) -> dict[str, object]:
    return {
        "parameter": interval.dimension.name,
        "axis": interval.dimension.axis,
        "value": interval.value,
        "low": interval.low,
        "high": interval.high,
    }


def show(result: TuningResult, output: Path) -> None:
    """Print the result of a tuning."""
    design = result.design
    sensor, tuning = design.sensor, design.tuning
    assert tuning is not None
    what = "inclination" if design.axes == "both" else design.axes
    texts = [fact.text() for fact in FILTERS[design.filter].facts(design)]
    click.echo(f"{design.filter}: {', '.join(texts)} at {design.rate_hz:g} Hz")
    for interval in result.intervals:
        click.echo(f"  {interval_text(interval)}")
    click.echo(f"RMSE of {what}: {errors_text(result)}")
    click.echo(
        f"sensor: +-{sensor.gyro_full_scale_deg_s} deg/s, +-{sensor.accel_full_scale_g} g, "
        f"low-pass setting {sensor.low_pass_setting}\n"
        f"{output}: design {digest(design)}, {tuning.optimiser}, "
        f"{result.swarm.evaluations} evaluations"
    )


def errors_text(result: TuningResult) -> str:
    """Return the training figure beside the held-out one."""
    count = len(result.evaluations)
    training = (
        f"{math.degrees(result.rms_rad):.4f} deg on the {count} training "
        f"recording{'s' if count > 1 else ''}"
    )
    held_out = result.held_out
    if held_out is None:
        return training
    return (
        f"{training}, {math.degrees(held_out.rms_rad):.4f} deg on {held_out.unit} left out "
        f"({held_out.folds} folds)"
    )


def interval_text(interval: Interval) -> str:
    """Return a parameter with its interval, as on the screen."""
    dimension = interval.dimension
    value, unit = dimension.shown(interval.value)
    text = f"{dimension.label}: {value:.4g} {unit}".rstrip()
    if interval.low is None or interval.high is None:
        return text
    low, high = dimension.shown(interval.low)[0], dimension.shown(interval.high)[0]
    return f"{text}, 95 % of resampled tunings within {low:.4g} to {high:.4g}"
