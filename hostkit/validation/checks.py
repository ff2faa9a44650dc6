"""What a verdict is made of: every figure beside its limit."""

from collections.abc import Callable
from dataclasses import dataclass

from hostkit.records import ResidualStatistics, ValidationReport
from hostkit.units import DEG_PER_RAD
from hostkit.validation.thresholds import MAX_UNJUDGED_SHARE, MAX_WAIT_S, Thresholds

MS_PER_S, S_PER_MIN = 1e3, 60.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Check:
    """One figure beside its limit, both as text with their unit; `reason` is empty if it is kept.

    `limit` is empty where there is none.
    """

    name: str
    figure: str
    limit: str
    reason: str = ""


def checks(report: ValidationReport, thresholds: Thresholds) -> tuple[Check, ...]:
    """Return every figure of a report beside its limit, in a fixed order."""
    return (
        _steps(report),
        _every_sample(report),
        _parameters(report),
        *((_state(report),) if report.waiting else ()),
        _size("residual rms", "rms", report.rms_rad, thresholds.max_rms_deg),
        _size("largest residual", "at most", report.max_rad, thresholds.max_abs_deg),
        _size(
            "99th percentile",
            "in the 99th percentile",
            _worst(report, _p99),
            thresholds.max_p99_deg,
        ),
        _lost(report, thresholds.max_lost_share),
        _measured("lag", "ms", MS_PER_S, _worst(report, _lag), thresholds.max_lag_ms),
        _measured(
            "drift",
            "deg/min",
            DEG_PER_RAD * S_PER_MIN,
            _worst(report, _drift),
            thresholds.max_drift_deg_min,
        ),
    )


def _steps(report: ValidationReport) -> Check:
    reason = ""
    if not report.checked:
        reason = "no step could be checked"
        if report.waiting:
            reason += ": the device has not told the state of its filter (TILT_STATE)"
    elif report.mismatches:
        model = "the integer model"
        if report.tolerance_rad is not None:
            model = f"the float model by more than {report.tolerance_rad * DEG_PER_RAD:.3g} deg"
        reason = f"{report.mismatches} of {report.checked} steps differ from {model}"
    figure = f"{report.mismatches} of {report.checked} wrong"
    return Check(name="steps", figure=figure, limit="0", reason=reason)


def _every_sample(report: ValidationReport) -> Check:
    reason = ""
    if report.stride > 1:
        reason = (
            f"only every {_ordinal(report.stride)} sample is sent; the steps between cannot be "
            "computed: have it send TILT_SAMPLE with every sample"
        )
    return Check(name="sample stride", figure=str(report.stride), limit="1", reason=reason)


def _parameters(report: ValidationReport) -> Check:
    reason = ""
    if report.untold:
        names = ", ".join(report.untold)
        reason = f"the device uses other parameters than its design's and has not told {names}"
    unknown = report.unjudged - report.waiting
    if not reason and report.stride == 1 and unknown > MAX_UNJUDGED_SHARE * report.samples:
        reason = f"{unknown} of {report.samples} samples came before their parameters were known"
    figure = f"{unknown} of {report.samples} not judged"
    limit = f"{MAX_UNJUDGED_SHARE:.0%}"
    return Check(name="parameters known", figure=figure, limit=limit, reason=reason)


def _state(report: ValidationReport) -> Check:
    """Compare how long a gap lasted until the device told the state of its filter."""
    waited_s, reason = report.longest_wait_s, ""
    if waited_s > MAX_WAIT_S:
        reason = (
            f"the state of the filter was not known for {waited_s:.1f} s; "
            "have the device send TILT_STATE more often"
        )
    figure = f"{report.waiting} samples not judged, {waited_s:.1f} s at most"
    return Check(name="state told", figure=figure, limit=f"{MAX_WAIT_S:g} s", reason=reason)


def _size(name: str, kind: str, value_rad: float | None, limit_deg: float | None) -> Check:
    """Compare a size of the residual; without one the steps are what failed."""
    value = None if value_rad is None else value_rad * DEG_PER_RAD
    reason = ""
    if value is not None and limit_deg is not None and value > limit_deg:
        reason = f"residual {value:.6f} deg {kind} exceeds {limit_deg:g} deg"
    figure = "none" if value is None else f"{value:.6f} deg"
    return Check(name=name, figure=figure, limit=_limit(limit_deg, "deg"), reason=reason)


def _lost(report: ValidationReport, limit: float | None) -> Check:
    sent = report.samples + report.lost
    reason = ""
    if limit is not None and report.lost > limit * sent:
        reason = f"{report.lost} of {sent} samples were lost"
    share = 100.0 * report.lost / sent if sent else 0.0
    return Check(
        name="lost samples",
        figure=f"{report.lost} of {sent}, {share:.3f} %",
        limit=_limit(None if limit is None else 100.0 * limit, "%"),
        reason=reason,
    )


def _measured(
    name: str, unit: str, per_unit: float, value: float | None, limit: float | None
) -> Check:
    """Compare a figure that is not always there; a limit on one that is not there is not kept."""
    shown = None if value is None else value * per_unit
    reason = ""
    if limit is not None and shown is None:
        reason = f"the {name} could not be measured, and at most {limit:g} {unit} is asked for"
    elif limit is not None and shown is not None and abs(shown) > limit:
        reason = f"{name} {shown:.6f} {unit} exceeds {limit:g} {unit}"
    figure = "not measured" if shown is None else f"{shown:.6f} {unit}"
    return Check(name=name, figure=figure, limit=_limit(limit, unit), reason=reason)


def _limit(value: float | None, unit: str) -> str:
    return "" if value is None else f"{value:g} {unit}"


def _worst(
    report: ValidationReport, of: Callable[[ResidualStatistics], float | None]
) -> float | None:
    """Return the value of the axis where it is greatest in size."""
    values = [value for entry in report.residual if (value := of(entry)) is not None]
    return max(values, key=abs, default=None)


def _p99(entry: ResidualStatistics) -> float | None:
    return entry.p99_rad


def _lag(entry: ResidualStatistics) -> float | None:
    return entry.lag_s


def _drift(entry: ResidualStatistics) -> float | None:
    return entry.drift_rad_s


def _ordinal(number: int) -> str:
    last = {1: "st", 2: "nd", 3: "rd"}.get(number % 10, "th")
    return f"{number}{'th' if number % 100 in (11, 12, 13) else last}"
