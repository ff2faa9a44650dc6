"""The result of a session as a document of plain JSON values."""

from dataclasses import asdict

from hostkit.link.statistics import Spread, TimingStatistics
from hostkit.monitor.result import SessionResult
from hostkit.monitor.snapshot import SessionInfo
from hostkit.records import ResidualStatistics, RetunedParameter
from hostkit.units import DEG_PER_RAD
from hostkit.validation import Check, checks

Document = dict[str, object]


def monitor_document(result: SessionResult) -> Document:
    """Return the result of a session as the document ``hostkit.monitor/1``."""
    report, link = result.report, result.link
    return {
        "schema": "hostkit.monitor/1",
        "samples": report.samples,
        "checked": report.checked,
        "lost": report.lost,
        "late": report.late,
        "repeated": report.repeated,
        "unjudged": report.unjudged,
        "waiting": report.waiting,
        "longest_wait_s": report.longest_wait_s,
        "stride": report.stride,
        "lost_frames": link.lost_frames,
        "bad": link.bad,
        "bad_bytes": link.bad_bytes,
        "unknown": link.unknown,
        "rms_deg": _deg(report.rms_rad),
        "max_deg": _deg(report.max_rad),
        "residual": [_residual(entry) for entry in report.residual],
        "mismatches": report.mismatches,
        "tolerance_deg": _deg(report.tolerance_rad),
        "retuned": [_retuned(entry) for entry in report.retuned],
        "untold": list(report.untold),
        "digest_ok": report.digest_ok,
        "duration_s": result.duration_s,
        "reconnects": result.reconnects,
        "thresholds": asdict(result.thresholds),
        "checks": [_check(check) for check in checks(report, result.thresholds)],
        "link": _link(result),
        "timing": _timing(result.timing),
        "session": None if result.info is None else _session(result.info),
        "texts": list(result.device.texts),
        "verdict": report.verdict,
        "reasons": list(report.reasons),
    }


def _session(info: SessionInfo) -> Document:
    """Return what was judged; the facts of its filter stand among the rest."""
    document: Document = asdict(info)
    del document["facts"]
    return {**document, **{fact.name: fact.value for fact in info.facts}}


def _deg(angle_rad: float | None) -> float | None:
    return None if angle_rad is None else angle_rad * DEG_PER_RAD


def _residual(entry: ResidualStatistics) -> Document:
    drift = _deg(entry.drift_rad_s)
    return {
        "axis": entry.axis,
        "samples": entry.samples,
        "rms_deg": _deg(entry.rms_rad),
        "max_deg": _deg(entry.max_rad),
        "mean_deg": _deg(entry.mean_rad),
        "p50_deg": _deg(entry.p50_rad),
        "p95_deg": _deg(entry.p95_rad),
        "p99_deg": _deg(entry.p99_rad),
        "lag_ms": None if entry.lag_s is None else 1e3 * entry.lag_s,
        "drift_deg_min": None if drift is None else 60.0 * drift,
    }


def _retuned(entry: RetunedParameter) -> Document:
    return {
        "name": entry.name,
        "unit": entry.unit,
        "design_value": entry.design_value,
        "device_value": entry.device_value,
    }


def _check(check: Check) -> Document:
    return {
        "name": check.name,
        "figure": check.figure,
        "limit": check.limit or None,
        "kept": not check.reason,
        "reason": check.reason,
    }


def _link(result: SessionResult) -> Document:
    document: Document = asdict(result.link)
    document["sources"] = [asdict(source) for source in result.link.sources]
    return document


def _timing(timing: TimingStatistics) -> Document:
    return {
        "round_trip_ms": timing.round_trip_ms,
        "clock_ppm": timing.clock_ppm,
        "latency": _spread(timing.latency),
        "jitter": _spread(timing.jitter),
    }


def _spread(spread: Spread | None) -> Document | None:
    return None if spread is None else asdict(spread)
