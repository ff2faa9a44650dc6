"""What ``compare`` says on the screen."""

import math

import click

from hostkit.comparison import Comparison, Cost, Row, cost_of


def show(comparison: Comparison, costs: tuple[Cost, ...]) -> None:
    """Print one table of errors and costs, and then what is to be known of it."""
    count = len(comparison.recordings)
    lead = f", told {comparison.lead_s * 1e3:g} ms ahead" if comparison.lead_s else ""
    click.echo(
        f"RMSE of {comparison.quantity} over {count} recording{'s' if count > 1 else ''}, "
        f"deg: mean and worst{lead}"
    )
    width = max(len(row.title) for row in comparison.rows)
    click.echo(
        f"{'filter':<{width}}  {'settings':<9}{'mean':>8}{'worst':>8}"
        f"{'left out':>10}{'worst':>8}{'tried':>7}{'ns/sample':>11}"
    )
    for row in comparison.rows:
        click.echo(_line(row, costs, width))
    for cost in costs:
        if cost.ns_per_sample is not None:
            click.echo(f"{cost.title}: {cost.ns_per_sample:.3g} ns a sample ({cost.timed})")
        else:
            click.echo(f"{cost.title}: not timed ({cost.timed}): {cost.reason}")
    for text in remarks(comparison):
        click.echo(text)


def _line(row: Row, costs: tuple[Cost, ...], width: int) -> str:
    held_out = row.held_out
    left = (
        f"{math.degrees(held_out.rms_rad):10.3f}{math.degrees(row.honest_worst_rad):8.2f}"
        if held_out is not None
        else f"{'-':>10}{'-':>8}"
    )
    own = cost_of(row, costs)
    tried = str(row.evaluations) if row.evaluations else "-"
    return (
        f"{row.title:<{width}}  {row.settings:<9}{math.degrees(row.mean_rad):8.3f}"
        f"{math.degrees(row.worst_rad):8.2f}{left}{tried:>7}"
        f"{'-' if own is None else f'{own:.0f}':>11}"
    )


def remarks(comparison: Comparison) -> tuple[str, ...]:
    """Return what is to be known of the figures, a sentence each."""
    rows = comparison.rows
    found = []
    if any(row.held_out is not None for row in rows):
        found.append(
            "left out: each recording (or part of a single one) scored by settings that were "
            "tuned without it; mean and worst before it are of the recordings tuned on"
        )
    scaled = sorted({row.title for row in rows if row.is_scaled})
    if scaled:
        found.append(f"tuned with the scale of the gyroscope: {', '.join(scaled)}")
    ahead = sorted({row.title for row in rows if row.lead_s != comparison.lead_s})
    if ahead:
        found.append(f"cannot be told so far ahead: {', '.join(ahead)}")
    offline = sorted({row.title for row in rows if row.is_offline})
    if offline:
        found.append(f"looks ahead, so no device can run it: {', '.join(offline)}")
    if comparison.calibrated_peers:
        found.append("peers read what the design's calibration makes of the readings")
    if comparison.trained_on:
        found.append(
            f"the design was tuned on {comparison.trained_on} of these recordings, so its figure "
            "is a training figure"
        )
    found += [f"{one.name} is missing: {one.reason}" for one in comparison.missing]
    return tuple(found)
