"""What a device must keep to pass."""

import math
from dataclasses import dataclass, fields

from hostkit.errors import HostkitError
from hostkit.records import Acceptance, FilterDesign

DEFAULT_MAX_RMS_DEG = 0.005
"""Largest residual against the float model that passes, deg."""

DEFAULT_MAX_LOST_SHARE = 0.01
"""Largest share of samples that may be lost on the way."""

MAX_UNJUDGED_SHARE = 0.5
"""Largest share of samples that may come while the parameters in use are not known."""

MAX_WAIT_S = 10.0
"""Longest time without a told state where one is needed, s; devices tell it every second."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Thresholds:
    """What a device must keep to pass; None is no limit.

    Attributes
    ----------
    max_rms_deg, max_abs_deg, max_p99_deg
        RMS, largest and 99th percentile of the residual device minus float model; the percentile
        and the lag are those of the worst axis.
    max_lost_share
        Share of samples that may be lost.
    max_lag_ms, max_drift_deg_min
        Size of the lag behind the float model, and of the slope of the residual. A limit on what
        could not be measured is not kept.
    """

    max_rms_deg: float | None = DEFAULT_MAX_RMS_DEG
    max_lost_share: float | None = DEFAULT_MAX_LOST_SHARE
    max_abs_deg: float | None = None
    max_p99_deg: float | None = None
    max_lag_ms: float | None = None
    max_drift_deg_min: float | None = None

    def __post_init__(self) -> None:
        """Refuse a threshold that nothing can exceed, or everything does."""
        for item in fields(self):
            value = getattr(self, item.name)
            if value is not None and not (math.isfinite(value) and value >= 0.0):
                raise HostkitError(f"{item.name} = {value}; it must be a finite number, 0 or more")

    @classmethod
    def of(
        cls,
        design: FilterDesign,
        *,
        max_rms_deg: float | None = None,
        max_lost_share: float | None = None,
        max_abs_deg: float | None = None,
        max_p99_deg: float | None = None,
        max_lag_ms: float | None = None,
        max_drift_deg_min: float | None = None,
    ) -> "Thresholds":
        """Return the limits of a design; one that is given wins, and the default comes last."""
        own = design.acceptance or Acceptance()
        return cls(
            max_rms_deg=_first(max_rms_deg, own.max_rms_deg, DEFAULT_MAX_RMS_DEG),
            max_lost_share=_first(max_lost_share, own.max_lost_share, DEFAULT_MAX_LOST_SHARE),
            max_abs_deg=_first(max_abs_deg, own.max_abs_deg),
            max_p99_deg=_first(max_p99_deg, own.max_p99_deg),
            max_lag_ms=_first(max_lag_ms, own.max_lag_ms),
            max_drift_deg_min=_first(max_drift_deg_min, own.max_drift_deg_min),
        )


def _first(*values: float | None) -> float | None:
    return next((value for value in values if value is not None), None)
