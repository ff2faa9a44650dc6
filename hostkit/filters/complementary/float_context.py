"""What templates see of the filter in floats: its parameters as text of C, without suffix."""

from dataclasses import dataclass

from hostkit.filters.complementary.lowering import bias_unit_rad_s
from hostkit.filters.complementary.parameters import BIAS_LIMIT_RAD_S, settings, tau_from_eta
from hostkit.filters.complementary.spec import ComplementarySpec
from hostkit.literals import float32_text
from hostkit.records import AXES, FilterDesign
from hostkit.sensors import SENSORS


@dataclass(frozen=True, slots=True, kw_only=True)
class FloatAxisContext:
    """One axis of the design.

    Attributes
    ----------
    name, rate_axis
        Name of the axis, and of the body axis whose rate raises it.
    rad_s_per_count, rad_per_count
        What one count of rate is, and what it turns in a sample; the scale is put right.
    bias_rad_s, tilt_offset_rad
        Those of the design.
    """

    name: str
    rate_axis: str
    rad_s_per_count: str
    rad_per_count: str
    bias_rad_s: str
    tilt_offset_rad: str


@dataclass(frozen=True, slots=True, kw_only=True)
class FloatContext:
    """The filter of a design in floats.

    Attributes
    ----------
    bias_gain_per_s
        Integral gain times the sample period, 0 without an integral.
    bias_limit_rad_s
        Where the bias of an integral stops.
    bias_words_per_rad_s
        Units of a bias on the link per rad/s.
    gravity_count
        Accelerometer count of 1 g.
    """

    axes: tuple[FloatAxisContext, ...]
    tau_s: str
    bias_gain_per_s: str
    bias_limit_rad_s: str
    bias_words_per_rad_s: str
    gravity_count: str


def float_context(design: FilterDesign, spec: ComplementarySpec) -> FloatContext:
    """Lay out what the float templates need."""
    own = settings(design)
    gain = own.integral_gain_per_s2 or 0.0
    return FloatContext(
        axes=tuple(_axis(design, i) for i in range(len(spec.axes))),
        tau_s=float32_text(tau_from_eta(own.eta, design.period_s)),
        bias_gain_per_s=float32_text(gain * design.period_s),
        bias_limit_rad_s=float32_text(BIAS_LIMIT_RAD_S),
        bias_words_per_rad_s=float32_text(1.0 / bias_unit_rad_s(design, spec.integral)),
        gravity_count=float32_text(spec.gravity_count),
    )


def _axis(design: FilterDesign, i: int) -> FloatAxisContext:
    own, name = settings(design), AXES[design.axes][i]
    weight = SENSORS[design.sensor.part].rad_s_per_count(design.sensor)
    rad_s = (1.0 + own.gyro_scale[i]) * weight
    return FloatAxisContext(
        name=name,
        rate_axis={"roll": "x", "pitch": "y"}[name],
        rad_s_per_count=float32_text(rad_s),
        rad_per_count=float32_text(rad_s * design.period_s),
        bias_rad_s=float32_text(own.gyro_bias_rad_s[i]),
        tilt_offset_rad=float32_text(own.tilt_offset_rad[i]),
    )
