"""The report of a session: its verdict, what it stands on, and how the link did."""

from pathlib import Path

from hostkit.files import write_aside
from hostkit.link.statistics import Spread
from hostkit.monitor.result import SessionResult
from hostkit.records import ResidualStatistics, ValidationReport
from hostkit.report import monitor_figures as figures
from hostkit.report.page import Fact, Page, Plot, Table, page_text
from hostkit.report.plain_text import plain_text
from hostkit.units import DEG_PER_RAD
from hostkit.validation import checks


def write_monitor_report(result: SessionResult, path: Path) -> None:
    """Write the report of a session as one HTML file.

    Raises
    ------
    ToolMissingError
        If matplotlib is not installed.
    HostkitError
        If the file cannot be written.
    """
    write_aside(path, monitor_page(result))


def monitor_page(result: SessionResult) -> str:
    """Return the report of a session as the text of an HTML file without script.

    Raises
    ------
    ToolMissingError
        If matplotlib is not installed.
    """
    return page_text(
        Page(
            title="Device against model",
            subtitle=_subtitle(result),
            verdict=result.report.verdict,
            facts=_facts(result),
            sections=(
                *_reasons(result),
                _checks(result),
                *_plots(result),
                _residual(result),
                *_retuned(result),
                _link(result),
                _timing(result),
                *_texts(result),
            ),
            provenance=_provenance(result),
        )
    )


def _subtitle(result: SessionResult) -> str:
    if result.info is None:
        return f"{result.duration_s:.1f} s"
    replayed = "replayed from" if result.info.replay else "at"
    port = plain_text(result.info.port)
    return f"Design {result.info.design_digest}, {replayed} {port}, {result.duration_s:.1f} s."


def _facts(result: SessionResult) -> tuple[Fact, ...]:
    report = result.report
    return (
        Fact(label="samples", value=str(report.samples), note=f"{report.checked} steps checked"),
        Fact(label="mismatches", value=str(report.mismatches), note=_judged_by(report)),
        Fact(label="residual", value=_deg(report.rms_rad), note="rms, against the float model"),
        Fact(label="largest residual", value=_deg(report.max_rad)),
        Fact(
            label="lost samples",
            value=str(report.lost),
            note=f"{report.late} late, {report.repeated} repeated",
        ),
    )


def _judged_by(report: ValidationReport) -> str:
    if report.tolerance_rad is None:
        return "against the integer model"
    return f"beyond {report.tolerance_rad * DEG_PER_RAD:.3g} deg of the float model"


def _reasons(result: SessionResult) -> tuple[Table, ...]:
    if not result.report.reasons:
        return ()
    rows = tuple((plain_text(reason),) for reason in result.report.reasons)
    return (Table(title="Why not pass", header=("reason",), rows=rows, is_text=True),)


def _checks(result: SessionResult) -> Table:
    return Table(
        title="Figures and limits",
        header=("what", "figure", "limit", "kept"),
        rows=tuple(
            (c.name, c.figure, c.limit or "none", "no" if c.reason else "yes" if c.limit else "-")
            for c in checks(result.report, result.thresholds)
        ),
        note="Of percentile, lag and drift the worst axis counts.",
        is_text=True,
    )


def _names(result: SessionResult) -> tuple[str, ...]:
    if result.info is not None:
        return result.info.axes
    return tuple(entry.axis for entry in result.report.residual)


def _plots(result: SessionResult) -> tuple[Plot, ...]:
    plots, names = [], _names(result)
    overlay = result.overlay
    if overlay is not None and len(overlay.time_s) and overlay.device_rad.shape[1] == len(names):
        together = overlay.samples_per_point
        caption = "Gaps are samples that do not follow the one before them."
        if together > 1:
            caption += (
                f" Each point stands for {together} samples: angles of the first, and the greatest "
                "residual of all."
            )
        svg = figures.overlay_figure(overlay, names)
        plots.append(Plot(title="Device over model", caption=caption, svg=svg))
    if any(histogram.counts.any() for histogram in result.residual_histogram):
        svg = figures.residual_sizes(
            result.residual_histogram, names, result.thresholds.max_rms_deg
        )
        caption = "The outermost classes hold all that is smaller or larger."
        plots.append(Plot(title="Size of the residual", caption=caption, svg=svg))
    jitter = result.jitter_histogram
    if jitter is not None and jitter.counts.any():
        caption = "Time between two arrivals less the time between their samples."
        svg = figures.jitter_sizes(jitter)
        plots.append(Plot(title="Jitter of arrival", caption=caption, svg=svg))
    return tuple(plots)


def _residual(result: SessionResult) -> Table:
    return Table(
        title="Residual, device minus float model",
        header=("axis", "samples", "rms", "max", "mean", "p50", "p95", "p99", "lag", "drift"),
        rows=tuple(_residual_row(entry) for entry in result.report.residual),
        note=(
            "1e-6 deg; percentiles of the size, right within 1 %; lag in us, from the latest 4096 "
            "samples at most; drift in 1e-6 deg per minute, from one minute on."
        ),
    )


def _residual_row(entry: ResidualStatistics) -> tuple[str, ...]:
    sizes = (
        entry.rms_rad,
        entry.max_rad,
        entry.mean_rad,
        entry.p50_rad,
        entry.p95_rad,
        entry.p99_rad,
    )
    return (
        entry.axis,
        str(entry.samples),
        *(f"{size * DEG_PER_RAD * 1e6:.3g}" for size in sizes),
        "-" if entry.lag_s is None else f"{entry.lag_s * 1e6:.3g}",
        "-" if entry.drift_rad_s is None else f"{entry.drift_rad_s * DEG_PER_RAD * 60e6:.3g}",
    )


def _retuned(result: SessionResult) -> tuple[Table, ...]:
    if not result.report.retuned:
        return ()
    rows = tuple(
        (p.name, f"{p.design_value:.9g}", f"{p.device_value:.9g}", p.unit)
        for p in result.report.retuned
    )
    return (
        Table(
            title="Parameters that are not the design's",
            header=("name", "design", "device", "unit"),
            rows=rows,
            note="Each sample was judged with the parameters that were in use when it was made.",
        ),
    )


def _link(result: SessionResult) -> Table:
    link = result.link
    rows = tuple(
        (
            f"{s.system}.{s.component}",
            *(str(n) for n in (s.frames, s.lost, s.duplicated, s.reordered, s.restarts)),
        )
        for s in link.sources
    )
    return Table(
        title="Link",
        header=("sender", "frames", "lost", "duplicated", "reordered", "restarts"),
        rows=rows,
        note=(
            f"{link.received_bytes} bytes came; {link.bad} pieces of {link.bad_bytes} bytes were "
            f"no frame, {link.crc_failures} of them with a wrong checksum; "
            f"{link.bad_signatures} refused for their signature, {link.unknown} of an unknown id; "
            f"found again {link.resyncs} times; {link.overrun_bytes} bytes dropped by the host; "
            f"{result.reconnects} reconnections."
        ),
    )


def _timing(result: SessionResult) -> Table:
    timing = result.timing
    trip = "not measured" if timing.round_trip_ms is None else f"{timing.round_trip_ms:.3f} ms"
    clock = "not measured" if timing.clock_ppm is None else f"{timing.clock_ppm:.1f} ppm"
    return Table(
        title="Timing",
        header=("what", "median, ms", "95th percentile, ms", "max, ms"),
        rows=(
            ("latency", *_spread(timing.latency)),
            ("jitter", *_spread(timing.jitter)),
        ),
        note=f"Round trip of TIMESYNC: {trip}; the device's clock against the host's: {clock}.",
    )


def _spread(spread: Spread | None) -> tuple[str, ...]:
    if spread is None:
        return ("-", "-", "-")
    return tuple(f"{value:.3f}" for value in (spread.median_ms, spread.p95_ms, spread.max_ms))


def _texts(result: SessionResult) -> tuple[Table, ...]:
    rows = [("device", plain_text(text)) for text in result.device.texts]
    rows += [(notice.level, plain_text(notice.text)) for notice in result.notices]
    if not rows:
        return ()
    return (Table(title="Said", header=("by", "text"), rows=tuple(rows), is_text=True),)


def _provenance(result: SessionResult) -> tuple[tuple[str, str], ...]:
    found = [("duration", f"{result.duration_s:.3f} s")]
    info = result.info
    if info is not None:
        found += [
            ("design", info.design_digest),
            ("axes, rate", f"{', '.join(info.axes)}, {info.rate_hz:g} Hz"),
            ("filter", ", ".join((info.filter, *(fact.text() for fact in info.facts)))),
            ("port", plain_text(info.port)),
            ("hostkit", info.hostkit_version),
        ]
    if result.device.version is not None:
        found.append(("firmware", plain_text(result.device.version)))
    return tuple(found)


def _deg(angle_rad: float | None) -> str:
    return "none" if angle_rad is None else f"{angle_rad * DEG_PER_RAD:.6f} deg"
