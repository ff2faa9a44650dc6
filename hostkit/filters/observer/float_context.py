"""What templates see of the observer in floats: its constants as text of C."""

from dataclasses import dataclass

from hostkit.filters.observer.limits import (
    ACCELERATION_LIMIT_M_S2,
    CLIP_GAIN,
    FIRST_FORCE_G,
    LEAD_LIMIT_RAD,
    REST_RATE_LIMIT_RAD_S,
    START_GAIN,
    START_LIMIT_RAD,
    correction_limit_rad,
    mean_shift,
    start_end,
)
from hostkit.filters.observer.parameters import BIAS_LIMIT_RAD_S
from hostkit.filters.observer.settings import Rest, Settings, settings
from hostkit.filters.observer.spec import ObserverSpec
from hostkit.filters.sensor_terms import SENSOR_AXES
from hostkit.literals import float32_text
from hostkit.records import FilterDesign
from hostkit.sensors import SENSORS
from hostkit.units import STANDARD_GRAVITY_M_S2

NO_REST = Rest(rate_rad_s=0.0, force_m_s2=0.0, gain_per_s=0.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class RealContext:
    """A constant: its name in small letters, C99 hexadecimal text without suffix, what it is."""

    name: str
    text: str
    title: str


def real_constants(design: FilterDesign, spec: ObserverSpec) -> tuple[RealContext, ...]:
    """Return the constants of the code in floats."""
    own = settings(design)
    named = (
        *_readings(design, own),
        *_limits(design, own),
        *_means(design, own),
        *(
            (f"{word.name}_per_unit", 1.0 / word.per_unit, f"words per {word.unit}")
            for word in spec.hidden
        ),
    )
    return tuple(
        RealContext(name=name, text=float32_text(value), title=title)
        for name, value, title in named
    )


def _readings(design: FilterDesign, own: Settings) -> tuple[tuple[str, float, str], ...]:
    part, cal = SENSORS[design.sensor.part], own.calibration
    rad_s, m_s2 = part.rad_s_per_count(design.sensor), part.m_s2_per_count(design.sensor)
    found = [
        ("rad_s_per_count", rad_s, "rad/s"),
        ("m_s2_per_count", m_s2, "m/s^2"),
        ("period", design.period_s, "s"),
    ]
    for i, axis in enumerate(SENSOR_AXES):
        found += [
            (f"gyro_factor_{axis}", 1.0 + cal.gyro_scale[i], "of the rate"),
            (f"accel_factor_{axis}", 1.0 + cal.accel_scale[i], "of the specific force"),
            (f"accel_offset_{axis}", cal.accel_offset_m_s2[i], "m/s^2"),
        ]
    return tuple(found)


def _limits(design: FilterDesign, own: Settings) -> tuple[tuple[str, float, str], ...]:
    first = FIRST_FORCE_G * STANDARD_GRAVITY_M_S2
    return (
        ("gravity", STANDARD_GRAVITY_M_S2, "m/s^2"),
        ("first_force_limit", first, "m/s^2"),
        ("acceleration_limit", ACCELERATION_LIMIT_M_S2, "m/s^2"),
        ("correction_limit", correction_limit_rad(design.period_s), "rad"),
        ("bias_limit", BIAS_LIMIT_RAD_S, "rad/s"),
        ("start_limit", START_LIMIT_RAD, "rad"),
        ("clip_gain", CLIP_GAIN, "weight of the alignment"),
        ("clip_rate", own.clip_rate_rad_s or 0.0, "rad/s"),
        ("lead", own.lead_s, "s"),
        ("lead_limit", LEAD_LIMIT_RAD, "rad"),
    )


def _means(design: FilterDesign, own: Settings) -> tuple[tuple[str, float, str], ...]:
    rest, end = own.rest or NO_REST, start_end(own.start_s, design.period_s)
    return (
        ("start_gain", START_GAIN if end < START_GAIN else 0.0, "first weight of the alignment"),
        ("start_end", end, "and that at which it is over"),
        ("mean_weight", 2.0 ** -mean_shift(design.period_s), "of a new reading"),
        ("mean_limit", REST_RATE_LIMIT_RAD_S, "rad/s"),
        ("rest_rate", rest.rate_rad_s, "rad/s"),
        ("rest_force", rest.force_m_s2, "m/s^2"),
        ("rest_gain", rest.gain_per_s * design.period_s, "of a sample"),
    )
