"""Units of a log: stated, or concluded from the numbers where they leave no doubt."""

from dataclasses import dataclass

import numpy as np

from hostkit.errors import RecordingError
from hostkit.importers.log import Vector
from hostkit.importers.options import TIME_UNITS, ForceUnit, RateUnit, TimeUnit
from hostkit.recordings.recording import Recording
from hostkit.recordings.sanity.agreement import Agreement, agreement
from hostkit.records import RATE_LIMITS_HZ
from hostkit.sensors import SENSORS
from hostkit.units import RAD_PER_DEG, STANDARD_GRAVITY_M_S2

PART = SENSORS["mpu6050"]

TICKS_PER_S: dict[TimeUnit, float] = {"s": 1.0, "ms": 1e3, "us": 1e6, "ns": 1e9}
RAD_S_PER: dict[RateUnit, float] = {
    "rad/s": 1.0,
    "deg/s": RAD_PER_DEG,
    "mrad/s": 1e-3,
    "mdeg/s": 1e-3 * RAD_PER_DEG,
}
M_S2_PER: dict[ForceUnit, float] = {
    "m/s2": 1.0,
    "g": STANDARD_GRAVITY_M_S2,
    "mg": 1e-3 * STANDARD_GRAVITY_M_S2,
}
COUNTS_FULL_SCALE = 32768.0

PLAUSIBLE_HZ = (4.5, 4500.0)
"""Sample rates that a log without a stated unit of time may have; a factor of 1000 apart."""
RATE_SLACK = 1.01
FORCE_TOLERANCE = 0.15
"""A median force this near to 1 g of a unit, relatively, is in that unit."""
UNIT_TOLERANCE = 3.0
RANGE_TOLERANCE = 1.25
"""How far the factor that fits best may be from a unit's, and from that of a range of counts.

Units are 57 apart, ranges 2; where a pendulum swings, the force shows only part of the tilt."""
RANGE_EXPLAINED = 0.8
"""Share of the turning of the force that the rate must explain before a range is told from it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Scale:
    """What to multiply values by, and what was concluded to find it; empty if it was stated."""

    factor: float
    guessed: str = ""


def time_unit(ticks: Vector, stated: TimeUnit | None) -> tuple[TimeUnit, str]:
    """Return the unit of a time column, and what was concluded.

    Without a statement it is the one unit in which the median step makes a sample rate within
    `PLAUSIBLE_HZ`.

    Raises
    ------
    RecordingError
        If no unit does, the stated one makes a rate that no sensor has, or the column may be a
        counter of rows.
    """
    steps = np.diff(ticks)
    step = float(np.median(steps)) if steps.size else 0.0
    if stated is not None:
        _require_sensible(step, stated)
        return stated, ""
    if steps.size and (steps == 1.0).all():
        raise RecordingError(
            "the time column counts 1, 2, 3 ...: it may be a row number or milliseconds; say "
            "--time-unit ms, or --columns without t and --rate-hz HZ"
        )
    low, high = PLAUSIBLE_HZ
    fitting = [u for u in TIME_UNITS if step > 0.0 and low <= TICKS_PER_S[u] / step < high]
    if not fitting:
        raise RecordingError(
            f"the unit of time cannot be told: its median step is {step:g}, which makes a sample "
            f"rate of {low:g} to {high:g} Hz in no unit; say --time-unit {'|'.join(TIME_UNITS)}"
        )
    rate_hz = TICKS_PER_S[fitting[0]] / step
    return fitting[0], f"time is in {fitting[0]}: its median step {step:g} makes {rate_hz:.4g} Hz"


def _require_sensible(step: float, unit: TimeUnit) -> None:
    low, high = RATE_LIMITS_HZ
    rate_hz = TICKS_PER_S[unit] / step if step > 0.0 else np.nan
    if rate_hz < low / RATE_SLACK or rate_hz > high * RATE_SLACK:
        raise RecordingError(
            f"time in {unit} makes a sample rate of {rate_hz:.4g} Hz, its median step is {step:g}; "
            f"sensors deliver {low} to {high:g} Hz: say --time-unit {'|'.join(TIME_UNITS)}"
        )


def force_scale(values: Vector, stated: ForceUnit | None, full_scale_g: float | None) -> Scale:
    """Return what brings a specific force, shape ``(N, 3)``, to m/s^2.

    Without a statement the median magnitude decides: gravity is nearly all of it.

    Raises
    ------
    RecordingError
        If that fits no unit, or the range of counts is not known.
    """
    if stated is not None and stated != "counts":
        return Scale(factor=M_S2_PER[stated])
    if full_scale_g is not None:
        return Scale(factor=full_scale_g * STANDARD_GRAVITY_M_S2 / COUNTS_FULL_SCALE)
    median = float(np.median(np.linalg.norm(values, axis=1)))
    if stated is None:
        for unit, weight in M_S2_PER.items():
            if _near_gravity(median * weight):
                return Scale(
                    factor=weight, guessed=f"force is in {unit}: its median is {median:.4g}"
                )
    for scale in PART.accel_ranges if _whole(values) else ():
        weight = PART.accel_m_s2_per_count(scale)
        if _near_gravity(median * weight):
            said = f"force is in counts at +-{scale.full_scale} g: its median is {median:.5g}"
            return Scale(factor=weight, guessed=said)
    raise RecordingError(_force_doubt(median, stated))


def _near_gravity(force_m_s2: float) -> bool:
    return abs(force_m_s2 / STANDARD_GRAVITY_M_S2 - 1.0) < FORCE_TOLERANCE


def _whole(values: Vector) -> bool:
    return bool((values == np.round(values)).all())


def _force_doubt(median: float, stated: ForceUnit | None) -> str:
    if stated == "counts":
        return (
            f"the median force is {median:.5g} counts, 1 g in no range of the {PART.title} (16384, "
            "8192, 4096 or 2048 counts); say --accel-range G"
        )
    return (
        f"the unit of the force cannot be told: its median magnitude is {median:.5g}, which is "
        "near 1 g neither in g (1), m/s2 (9.81), mg (1000) nor counts (2048, 4096, 8192, 16384); "
        "say --accel-unit m/s2|g|mg|counts; if gravity was taken out, export the raw values"
    )


def rate_scale(
    time_s: Vector,
    values: Vector,
    force_m_s2: Vector,
    stated: RateUnit | None,
    full_scale_deg_s: float | None,
) -> Scale:
    """Return what brings an angular rate, shape ``(N, 3)``, to rad/s.

    Without a statement the motion decides: the direction of the specific force must turn as fast
    as the rate says (`hostkit.recordings.sanity.agreement`).

    Raises
    ------
    RecordingError
        If the motion does not tell, or what it tells is no known unit.
    """
    if stated is not None and stated != "counts":
        return Scale(factor=RAD_S_PER[stated])
    if full_scale_deg_s is not None:
        return Scale(factor=full_scale_deg_s * RAD_PER_DEG / COUNTS_FULL_SCALE)
    found = _agreement(time_s, values, force_m_s2)
    if found is None or found.scale is None:
        raise RecordingError(_rate_doubt(stated))
    label, factor, in_counts = _nearest(found.scale, stated, _whole(values))
    tolerance = RANGE_TOLERANCE if in_counts else UNIT_TOLERANCE
    sure = found.explained > RANGE_EXPLAINED or not in_counts
    if sure and 1.0 / tolerance < found.scale / factor < tolerance:
        said = f"rate is in {label}: times {factor:.4g} it turns as the force does"
        return Scale(factor=factor, guessed=f"{said} ({found.scale:.4g} fits best)")
    raise RecordingError(
        f"the unit of the rate cannot be told: times {found.scale:.4g} it turns most like the "
        f"force, which explains {100.0 * found.explained:.0f} % of it; the nearest is {label}, "
        f"{factor:.4g}, and that is not sure enough; {_rate_remedy(stated)}"
    )


def _agreement(time_s: Vector, values: Vector, force_m_s2: Vector) -> Agreement | None:
    """Compare rate and force where they are finite and the time rises."""
    if time_s.size < 4:
        return None
    rising = np.concatenate(([True], np.diff(np.maximum.accumulate(time_s)) > 0.0))
    finite = np.isfinite(values).all(axis=1) & np.isfinite(force_m_s2).all(axis=1)
    kept = rising & finite & np.isfinite(time_s)
    if np.count_nonzero(kept) < 4:
        return None
    as_it_is = Recording(
        name="",
        time_s=time_s[kept],
        rate_hz=1.0,
        angular_rate_rad_s=values[kept],
        specific_force_m_s2=force_m_s2[kept],
        valid=np.ones(np.count_nonzero(kept), dtype=np.bool_),
    )
    return agreement(as_it_is)


def _nearest(needed: float, stated: RateUnit | None, whole: bool) -> tuple[str, float, bool]:
    """Return the unit or range whose factor is nearest: label, rad/s of one, whether counts."""
    units: tuple[RateUnit, ...] = () if stated == "counts" else ("rad/s", "deg/s")
    candidates: list[tuple[str, float, bool]] = [(u, RAD_S_PER[u], False) for u in units]
    for scale in PART.gyro_ranges if whole or stated == "counts" else ():
        label = f"counts at +-{scale.full_scale} deg/s"
        candidates.append((label, PART.gyro_rad_s_per_count(scale), True))
    return min(candidates, key=lambda found: abs(np.log(needed / found[1])))


def _rate_doubt(stated: RateUnit | None) -> str:
    what = "the range of the rate's counts" if stated == "counts" else "the unit of the rate"
    return (
        f"{what} cannot be told: the sensor hardly tilts, so nothing says how fast it turns; "
        f"{_rate_remedy(stated)}, or record some tilting"
    )


def _rate_remedy(stated: RateUnit | None) -> str:
    if stated == "counts":
        return "say --gyro-range DEG_S (an MPU-6050 starts with 250)"
    return "say --gyro-unit rad/s|deg/s, or --gyro-unit counts --gyro-range DEG_S"


def tilt_factor(
    angles: Vector, measured_rad: Vector, stated: str | None
) -> tuple[float, str] | None:
    """Return what brings reference angles to radians, and what was concluded.

    Without a statement both units are held against the tilt that the force shows.

    Parameters
    ----------
    angles
        Roll and pitch as they stand, shape ``(N, 2)``; may hold NaN.
    measured_rad
        The same from the specific force, rad.
    stated
        ``rad``, ``deg`` or None.

    Returns
    -------
    tuple or None
        None if neither unit fits clearly better.
    """
    if stated is not None:
        return (RAD_PER_DEG if stated == "deg" else 1.0), ""
    known = np.isfinite(angles).all(axis=1)
    if not known.any():
        return None
    misfit = {
        unit: float(np.median(np.abs(angles[known] * factor - measured_rad[known]).max(axis=1)))
        for unit, factor in (("rad", 1.0), ("deg", RAD_PER_DEG))
    }
    best, other = sorted(misfit, key=lambda unit: misfit[unit])
    if misfit[other] < 3.0 * misfit[best]:
        return None
    factor = RAD_PER_DEG if best == "deg" else 1.0
    return factor, f"reference angles are in {best}: so they agree with the force"
