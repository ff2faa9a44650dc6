"""The sanity card: what a recording is, and what about it deserves a second look."""

from dataclasses import dataclass

import numpy as np

from hostkit.recordings.recording import Recording
from hostkit.recordings.sanity.findings import Finding
from hostkit.recordings.sanity.sensor_findings import sensor_findings
from hostkit.recordings.sanity.soundness import require_sound
from hostkit.recordings.sanity.time_findings import time_findings
from hostkit.units import DEG_PER_RAD


@dataclass(frozen=True, slots=True, kw_only=True)
class SanityCard:
    """What the checks say of a recording that has no hard fault.

    Attributes
    ----------
    facts
        What the recording is, one line each.
    findings
        What deserves a second look; empty if nothing does.
    """

    facts: tuple[str, ...]
    findings: tuple[Finding, ...]

    def lines(self) -> tuple[str, ...]:
        """Return the card as lines of text: facts, then findings."""
        warnings = tuple(f"{finding.kind}: {finding.message}" for finding in self.findings)
        return self.facts + (warnings or ("no warnings",))


def check(recording: Recording) -> SanityCard:
    """Check a recording.

    Raises
    ------
    RecordingError
        If it has a hard fault (see `require_sound`).
    """
    require_sound(recording)
    return SanityCard(
        facts=(_time(recording), _range(recording), _reference(recording)),
        findings=(*time_findings(recording), *sensor_findings(recording)),
    )


def _time(recording: Recording) -> str:
    steps_ms = 1e3 * np.diff(recording.time_s)
    return (
        f"time: {len(recording)} samples at {recording.rate_hz:.6g} Hz, "
        f"{recording.duration_s:.4g} s; steps {steps_ms.min():.4g} / {np.median(steps_ms):.4g} / "
        f"{steps_ms.max():.4g} ms (least / median / most)"
    )


def _range(recording: Recording) -> str:
    force = np.linalg.norm(recording.specific_force_m_s2, axis=1)
    fastest_deg_s = DEG_PER_RAD * np.abs(recording.angular_rate_rad_s).max(axis=0)
    x, y, z = fastest_deg_s
    return (
        f"motion: fastest rate x {x:.4g}, y {y:.4g}, z {z:.4g} deg/s; median specific force "
        f"{np.median(force):.4g} m/s^2"
    )


def _reference(recording: Recording) -> str:
    valid = 100.0 * float(np.mean(recording.valid))
    if recording.up_reference is None:
        return f"reference: none; {valid:.3g} % of the samples valid"
    known = 100.0 * float(np.mean(np.isfinite(recording.up_reference).all(axis=1)))
    return f"reference: on {known:.3g} % of the samples; {valid:.3g} % of the samples valid"
