"""The overview of a fleet: how many devices, how their designs spread, and which failed."""

from pathlib import Path

import numpy as np

from hostkit.fleet import DeviceResult, FleetResult
from hostkit.report.canvas import BLUE, new_figure, svg_text
from hostkit.report.page import Fact, Page, Plot, Table, write_page

DECADE = 10.0
"""From this spread on an axis is logarithmic."""
BINS = 30


def write_fleet_report(result: FleetResult, path: Path) -> None:
    """Write the overview of a fleet as one HTML file.

    Raises
    ------
    ToolMissingError
        If matplotlib is not installed.
    HostkitError
        If the file cannot be written.
    """
    page = Page(
        title="Fleet report",
        subtitle=f"{len(result.devices)} devices, one design each",
        facts=_facts(result),
        sections=(*_failures(result), *_plots(result), *_designs(result)),
        provenance=(("designs", "each design file names its recordings, seed and versions"),),
    )
    write_page(page, path)


def _facts(result: FleetResult) -> tuple[Fact, ...]:
    errors = [d.rmse_deg for d in result.devices if d.rmse_deg is not None]
    facts = [
        Fact(label="tuned", value=str(len(result.of("ok"))), note="in this run"),
        Fact(label="unchanged", value=str(len(result.of("skipped"))), note="from earlier runs"),
        Fact(label="failed", value=str(len(result.of("failed"))), note="no new design"),
    ]
    for name in result.fact_names:
        told = [fact for d in result.devices for fact in d.facts if fact.name == name]
        values, unit = [fact.value for fact in told], told[0].unit
        facts.append(
            Fact(
                label=f"median {told[0].label}",
                value=f"{np.median(values):.4g} {unit}".rstrip(),
                note=f"{min(values):.3g} to {max(values):.3g} {unit}".rstrip(),
            )
        )
    if errors:
        note = f"training figure, {min(errors):.3f} to {max(errors):.3f} deg"
        facts.append(Fact(label="median RMSE", value=f"{np.median(errors):.3f} deg", note=note))
    return tuple(facts)


def _failures(result: FleetResult) -> tuple[Table, ...]:
    failed = result.of("failed")
    if not failed:
        return ()
    rows = tuple((d.device, str(d.recordings), d.error) for d in failed)
    header = ("device", "recordings", "reason")
    return (Table(title="Failed devices", header=header, rows=rows, is_text=True),)


def _plots(result: FleetResult) -> tuple[Plot, ...]:
    devices = [d for d in result.devices if d.digest is not None]
    told = {fact.name: fact for d in devices for fact in d.facts}
    found = [
        _plot(
            fact.note or fact.label,
            f"{fact.label}, {fact.unit}" if fact.unit else fact.label,
            [f.value for d in devices for f in d.facts if f.name == name],
        )
        for name, fact in told.items()
    ]
    errors = [d.rmse_deg for d in devices if d.rmse_deg is not None]
    found.append(_plot("errors", "RMSE on own recordings, deg", errors))
    return tuple(plot for plot in found if plot is not None)


def _plot(title: str, label: str, found: list[float]) -> Plot | None:
    if not found:
        return None
    values = np.array(found)
    figure, axes, mpl = new_figure()
    if values.min() > 0.0 and values.max() > DECADE * values.min():
        edges = np.geomspace(values.min() * 0.95, values.max() * 1.05, BINS + 1)
        axes.set_xscale("log")
    else:
        margin = 0.05 * float(np.ptp(values)) or 0.05 * abs(float(values[0])) or 1.0
        edges = np.linspace(values.min() - margin, values.max() + margin, BINS + 1)
    axes.hist(values, bins=edges, color=BLUE)
    axes.set(xlabel=label, ylabel="devices")
    return Plot(
        title=title[:1].upper() + title[1:],
        caption=f"{len(values)} devices with a design.",
        svg=svg_text(figure, mpl),
    )


def _designs(result: FleetResult) -> tuple[Table, ...]:
    names = result.fact_names
    rows = tuple(_row(device, names) for device in result.devices if device.digest is not None)
    if not rows:
        return ()
    header = ("device", "design", *names, "RMSE, deg", "recordings")
    note = "RMSE is the figure on the device's own recordings, that is, a training figure."
    return (Table(title="Designs", header=header, rows=rows, note=note),)


def _row(device: DeviceResult, names: tuple[str, ...]) -> tuple[str, ...]:
    facts = {fact.name: f"{fact.value:.6g}" for fact in device.facts}
    return (
        device.device,
        device.digest or "",
        *(facts.get(name, "") for name in names),
        "" if device.rmse_deg is None else f"{device.rmse_deg:.4f}",
        str(device.recordings),
    )
