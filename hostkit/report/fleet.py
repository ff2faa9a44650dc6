"""The overview of a fleet: how many devices, how their designs spread, and which failed."""

from collections.abc import Callable
from pathlib import Path

import numpy as np

from hostkit.fleet import DeviceResult, FleetResult
from hostkit.report.canvas import BLUE, new_figure, svg_text
from hostkit.report.page import Fact, Page, Plot, Table, write_page

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
    taus = [d.tau_s for d in result.devices if d.tau_s is not None]
    facts = [
        Fact(label="tuned", value=str(len(result.of("ok"))), note="in this run"),
        Fact(label="unchanged", value=str(len(result.of("skipped"))), note="from earlier runs"),
        Fact(label="failed", value=str(len(result.of("failed"))), note="no new design"),
    ]
    if taus:
        note = f"{min(taus):.3g} to {max(taus):.3g} s"
        facts.append(Fact(label="median tau", value=f"{np.median(taus):.3g} s", note=note))
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
    found = (
        _plot("Time constants", "tau, s", devices, lambda d: d.tau_s, logarithmic=True),
        _plot("Errors", "RMSE on own recordings, deg", devices, lambda d: d.rmse_deg),
    )
    return tuple(plot for plot in found if plot is not None)


def _plot(
    title: str,
    label: str,
    devices: list[DeviceResult],
    of: Callable[[DeviceResult], float | None],
    *,
    logarithmic: bool = False,
) -> Plot | None:
    values = np.array([value for d in devices if (value := of(d)) is not None])
    if not len(values):
        return None
    figure, axes, mpl = new_figure()
    if logarithmic:
        edges = np.geomspace(values.min() * 0.95, values.max() * 1.05, BINS + 1)
        axes.set_xscale("log")
    else:
        edges = np.linspace(0.0, values.max() * 1.05 or 1.0, BINS + 1)
    axes.hist(values, bins=edges, color=BLUE)
    axes.set(xlabel=label, ylabel="devices")
    return Plot(
        title=title, caption=f"{len(values)} devices with a design.", svg=svg_text(figure, mpl)
    )


def _designs(result: FleetResult) -> tuple[Table, ...]:
    rows = tuple(_row(device) for device in result.devices if device.digest is not None)
    if not rows:
        return ()
    header = ("device", "design", "eta", "tau, s", "RMSE, deg", "recordings")
    note = "RMSE is the figure on the device's own recordings, that is, a training figure."
    return (Table(title="Designs", header=header, rows=rows, note=note),)


def _row(device: DeviceResult) -> tuple[str, ...]:
    return (
        device.device,
        device.digest or "",
        "" if device.eta is None else f"{device.eta:.6f}",
        "" if device.tau_s is None else f"{device.tau_s:.4g}",
        "" if device.rmse_deg is None else f"{device.rmse_deg:.4f}",
        str(device.recordings),
    )
