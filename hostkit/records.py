"""The frozen records that flow from stage to stage."""

import math
from dataclasses import dataclass, field, fields
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from hostkit.errors import DesignError
from hostkit.mounting import Mounting
from hostkit.provenance import OBJECTIVES as OBJECTIVES
from hostkit.provenance import CalibrationRecord
from hostkit.provenance import Objective as Objective
from hostkit.provenance import RecordingDigest as RecordingDigest
from hostkit.provenance import TuningRecord as TuningRecord

Axis = Literal["roll", "pitch"]
AxisChoice = Literal["roll", "pitch", "both"]
TiltMethod = Literal["atan2", "arcsin"]

AXES: Final[dict[AxisChoice, tuple[Axis, ...]]] = {
    "roll": ("roll",),
    "pitch": ("pitch",),
    "both": ("roll", "pitch"),
}
TILT_METHODS: Final[tuple[TiltMethod, ...]] = ("atan2", "arcsin")

RATE_LIMITS_HZ: Final = (0.1, 8000.0)
"""Slowest and fastest sample rate of a design; 8 kHz is the MPU-6050's own gyroscope rate."""


def read_only(array: NDArray[np.generic]) -> None:
    """Make an array that a record holds unwritable."""
    array.flags.writeable = False


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorConfig:
    """How the sensor of a design is set: which part, ranges and low-pass setting."""

    part: str
    gyro_full_scale_deg_s: int
    accel_full_scale_g: int
    low_pass_setting: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Parameter:
    """One number of a filter, by name and unit (``"1"`` when it has none)."""

    name: str
    value: float
    unit: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Acceptance:
    """What a device of a design must keep to pass; None where the design says nothing.

    Attributes
    ----------
    max_rms_deg, max_abs_deg, max_p99_deg
        RMS, largest and 99th percentile of the residual device minus float model.
    max_lost_share
        Share of samples that may be lost, 0 to 1.
    max_lag_ms
        How far the device may be behind the float model or before it.
    max_drift_deg_min
        Largest slope of the residual, deg per minute.
    """

    max_rms_deg: float | None = None
    max_abs_deg: float | None = None
    max_p99_deg: float | None = None
    max_lost_share: float | None = None
    max_lag_ms: float | None = None
    max_drift_deg_min: float | None = None

    def __post_init__(self) -> None:
        """Refuse a limit that nothing can exceed, or everything does."""
        for item in fields(self):
            value = getattr(self, item.name)
            if value is not None and not (math.isfinite(value) and value >= 0.0):
                raise DesignError(
                    f"acceptance: {item.name} = {value}; it must be a finite number, 0 or more"
                )
        if self.max_lost_share is not None and self.max_lost_share > 1.0:
            raise DesignError(
                f"acceptance: max_lost_share = {self.max_lost_share}; it must be at most 1"
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class FilterDesign:
    """A tuned filter: all that code is rendered from.

    `acceptance` is no part of what a device runs, nor of the digest that names it.
    """

    filter: str
    axes: AxisChoice
    tilt: TiltMethod
    mounting: Mounting
    rate_hz: float
    sensor: SensorConfig
    parameters: tuple[Parameter, ...]
    tuning: TuningRecord | None = None
    acceptance: Acceptance | None = None
    calibration: CalibrationRecord | None = None

    def __post_init__(self) -> None:
        """Refuse a rate that no sensor has."""
        low, high = RATE_LIMITS_HZ
        if not low <= self.rate_hz <= high:
            raise DesignError(f"rate_hz = {self.rate_hz} is outside [{low}, {high}] Hz")

    @property
    def period_s(self) -> float:
        """Sample period."""
        return 1.0 / self.rate_hz

    def parameter(self, name: str) -> float:
        """Return the value of one parameter.

        Raises
        ------
        DesignError
            If the design does not have it.
        """
        for parameter in self.parameters:
            if parameter.name == name:
                return parameter.value
        known = ", ".join(p.name for p in self.parameters)
        raise DesignError(f"the design has no parameter {name!r}; it has: {known}")


@dataclass(frozen=True, slots=True, kw_only=True)
class GeneratedFile:
    """One rendered file: a relative POSIX path and its content."""

    path: str
    content: str


@dataclass(frozen=True, slots=True, kw_only=True)
class ResidualStatistics:
    """The residual device minus float model of one axis.

    Attributes
    ----------
    p50_rad, p95_rad, p99_rad
        Percentiles of its size.
    lag_s
        How far the device is behind the model, by cross-correlation of the angles; None where
        there is too little motion to tell.
    drift_rad_s
        Slope of the residual over time; None while there is less than a minute.
    """

    axis: Axis
    samples: int
    rms_rad: float
    max_rad: float
    mean_rad: float
    p50_rad: float
    p95_rad: float
    p99_rad: float
    lag_s: float | None = None
    drift_rad_s: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class RetunedParameter:
    """A parameter that the device uses with another value than its design has."""

    name: str
    design_value: float
    device_value: float
    unit: str


@dataclass(frozen=True, slots=True, kw_only=True)
class ValidationReport:
    """A device trace held against the integer and the float model.

    Attributes
    ----------
    samples, checked
        Samples that came, and steps of them that could be computed again.
    lost, late, repeated
        Samples that never came, came behind a later one, or came twice.
    mismatches
        Checked samples that differ from the integer model; of a filter in float, those further
        from the float model than its tolerance.
    unjudged
        Samples that no model could follow: every so many-th only is sent, or the parameters in
        use or the state of the filter were not known.
    waiting
        Those of them that came while only the state was not known: after a gap until the device
        told it.
    longest_wait_s
        The longest time that it was not known.
    stride
        Greatest step of the sample counter that the device kept to on purpose; 1 where it sends
        every sample.
    tolerance_rad
        That tolerance; None for a filter in integers.
    untold
        Parameters in use that are not the design's and whose value the device has not told.
    rms_rad, max_rad
        Residual device minus float model, over all axes.
    residual
        The same in detail, an entry for each axis of the design; empty without a residual.
    retuned
        Parameters in use that are not the design's, set over the link, calibrated or stored.
    reasons
        Why the verdict is not ``pass``.
    """

    samples: int
    checked: int
    lost: int
    mismatches: int
    rms_rad: float | None
    max_rad: float | None
    digest_ok: bool
    verdict: Literal["pass", "fail", "refused"]
    late: int = 0
    repeated: int = 0
    unjudged: int = 0
    waiting: int = 0
    longest_wait_s: float = 0.0
    stride: int = 1
    tolerance_rad: float | None = None
    untold: tuple[str, ...] = field(default=())
    residual: tuple[ResidualStatistics, ...] = field(default=())
    retuned: tuple[RetunedParameter, ...] = field(default=())
    reasons: tuple[str, ...] = field(default=())
