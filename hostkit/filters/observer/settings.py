"""The parameters of a design of the observer, checked and ready for the models."""

from dataclasses import dataclass

from hostkit.errors import DesignError
from hostkit.filters.observer.parameters import (
    BY_NAME,
    KINDS,
    ParameterName,
    checked_value,
)
from hostkit.filters.sensor_terms import SENSOR_AXES, SensorCorrection, Triple
from hostkit.records import FilterDesign

REST_NAMES: tuple[ParameterName, ...] = ("rest_rate", "rest_force", "rest_gain")
DECAY_LIMIT = 0.5
"""A velocity must keep more than half of itself from sample to sample."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Rest:
    """When the sensor is at rest, and how fast the bias then follows the mean rate.

    Attributes
    ----------
    rate_rad_s, force_m_s2
        Largest deviation from the running mean, on every axis.
    gain_per_s
        Share of the difference that the bias takes up in a second.
    """

    rate_rad_s: float
    force_m_s2: float
    gain_per_s: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Settings:
    """The parameters of a design.

    Attributes
    ----------
    kt_rad_m, kv_per_s, kb_per_s
        The gains.
    start_s
        Longest memory of the alignment at the start; None where the first sample alone aligns.
    rest
        None where rest is not looked for.
    clip_rate_rad_s
        Rate beyond which the gyroscope is clipped; None where that is not looked at.
    lead_s
        How far the angles are told ahead; negative for back.
    calibration
        What is put right on the readings; the bias is where the filter's own estimate starts from.
    """

    kt_rad_m: float
    kv_per_s: float
    kb_per_s: float
    start_s: float | None
    rest: Rest | None
    clip_rate_rad_s: float | None
    lead_s: float
    calibration: SensorCorrection


def settings(design: FilterDesign) -> Settings:
    """Return the parameters of a design, checked.

    Raises
    ------
    DesignError
        If one is outside its limits, a gain is missing, rest detection is there in part, the
        velocity decays by half or more in a sample, the design has a parameter that this filter
        does not, or asks for the arc sine.
    """
    _refuse_strangers(design)
    if design.tilt != "atan2":
        raise DesignError(f"tilt = {design.tilt!r}: the observer has no such angle; it has: atan2")
    kv = _required(design, "kv")
    if kv * design.period_s >= DECAY_LIMIT:
        raise DesignError(
            f"kv = {kv:g} 1/s takes {kv * design.period_s:.3g} of the velocity at each sample of "
            f"rate_hz = {design.rate_hz:g}; it must stay below {DECAY_LIMIT}, which is "
            f"{DECAY_LIMIT * design.rate_hz:g} 1/s"
        )
    return Settings(
        kt_rad_m=_required(design, "kt"),
        kv_per_s=kv,
        kb_per_s=_required(design, "kb"),
        start_s=_value(design, "start"),
        rest=_rest(design),
        clip_rate_rad_s=_value(design, "clip_rate"),
        lead_s=_value(design, "lead") or 0.0,
        calibration=SensorCorrection(
            gyro_bias_rad_s=_triple(design, "gyro_bias"),
            gyro_scale=_triple(design, "gyro_scale"),
            accel_offset_m_s2=_triple(design, "accel_offset"),
            accel_scale=_triple(design, "accel_scale"),
        ),
    )


def _refuse_strangers(design: FilterDesign) -> None:
    known = tuple(key for kind in KINDS for key in kind.names())
    for parameter in design.parameters:
        if parameter.name not in known:
            raise DesignError(
                f"the observer has no parameter {parameter.name!r}; it has: {', '.join(known)}"
            )


def _value(design: FilterDesign, name: ParameterName) -> float | None:
    kind = BY_NAME[name]
    return checked_value(design, kind, kind.key())


def _required(design: FilterDesign, name: ParameterName) -> float:
    value = _value(design, name)
    return design.parameter(BY_NAME[name].key()) if value is None else value


def _rest(design: FilterDesign) -> Rest | None:
    rate, force, gain = (_value(design, name) for name in REST_NAMES)
    if rate is None and force is None and gain is None:
        return None
    if rate is None or force is None or gain is None:
        keys = ", ".join(BY_NAME[name].key() for name in REST_NAMES)
        raise DesignError(f"rest detection needs all of: {keys}; the design has only some")
    return Rest(rate_rad_s=rate, force_m_s2=force, gain_per_s=gain)


def _triple(design: FilterDesign, name: ParameterName) -> Triple:
    kind = BY_NAME[name]
    x, y, z = (checked_value(design, kind, kind.key(axis)) or 0.0 for axis in SENSOR_AXES)
    return x, y, z
