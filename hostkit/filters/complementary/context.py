"""What templates see of the filter: its axes and its coefficients, with neutral ones to fill in."""

from dataclasses import dataclass, replace

from hostkit.filters.complementary.float_context import FloatContext, float_context
from hostkit.filters.complementary.run_time_context import RunTimeContext, run_time_context
from hostkit.filters.complementary.spec import BiasIntegral, ComplementarySpec, ForceGate
from hostkit.fixedpoint import Coefficient, QFormat
from hostkit.literals import float32_text
from hostkit.records import AXES, Axis, FilterDesign
from hostkit.units import RAD_PER_HALF_TURN_LSB

NO_GATE = ForceGate(lowest=0, highest=0)
NO_INTEGRAL = BiasIntegral(
    gain=Coefficient(
        name="integral_gain", real=0.0, unit="1", format=QFormat(width=18, fraction_bits=17), raw=0
    ),
    fraction_bits=1,
    limit_raw=0,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class AxisContext:
    """Roll or pitch. One that the design lacks has the rate gain of the other, and zeros.

    Attributes
    ----------
    name, rate_axis
        Name of the axis, and of the body axis whose rate raises it.
    present
        Whether the design has it.
    rate_gain, tilt_offset_raw, gyro_bias_raw
        As in the spec.
    rad_s_per_count
        What one count of rate is to the filter, its scale put right; C99 hexadecimal text.
    """

    name: Axis
    rate_axis: str
    present: bool
    rate_gain: Coefficient
    rad_s_per_count: str
    tilt_offset_raw: int = 0
    gyro_bias_raw: int = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class FilterContext:
    """The filter of a design; what it lacks is neutral, and the booleans say that it is unused.

    Attributes
    ----------
    axes
        Roll and pitch.
    bias_fraction_bits
        Those of the bias: 0 where it is constant.
    coefficients, all_coefficients
        Those of the design, and with those of what it lacks.
    uses_arcsin
        Whether a tilt is the arc sine of one component.
    real
        The filter in floats.
    run_time
        What can be changed while it runs.
    """

    axes: tuple[AxisContext, ...]
    bias_fraction_bits: int
    coefficients: tuple[Coefficient, ...]
    all_coefficients: tuple[Coefficient, ...]
    uses_gate: bool
    gate: ForceGate
    has_integral: bool
    integral: BiasIntegral
    uses_arcsin: bool
    real: FloatContext
    run_time: RunTimeContext


def filter_context(design: FilterDesign, spec: ComplementarySpec) -> FilterContext:
    """Lay out what templates need of the filter."""
    axes = tuple(_axis(spec, name, design.rate_hz) for name in AXES["both"])
    integral = spec.integral or NO_INTEGRAL
    own = () if spec.integral is None else (integral.gain,)
    return FilterContext(
        axes=axes,
        bias_fraction_bits=0 if spec.integral is None else integral.fraction_bits,
        coefficients=(*spec.rate_gains, spec.blend, *own),
        all_coefficients=(*(axis.rate_gain for axis in axes), spec.blend, integral.gain),
        uses_gate=spec.gate is not None,
        gate=spec.gate or NO_GATE,
        has_integral=spec.integral is not None,
        integral=integral,
        uses_arcsin=spec.tilt == "arcsin",
        real=float_context(design, spec),
        run_time=run_time_context(design, spec),
    )


def _rad_s(gain: Coefficient, rate_hz: float) -> str:
    return float32_text(gain.quantised * RAD_PER_HALF_TURN_LSB * rate_hz)


def _axis(spec: ComplementarySpec, name: Axis, rate_hz: float) -> AxisContext:
    rate_axis = {"roll": "x", "pitch": "y"}[name]
    if name not in spec.axes:
        gain = replace(spec.rate_gains[0], name=f"rate_gain_{name}")
        return AxisContext(
            name=name,
            rate_axis=rate_axis,
            present=False,
            rate_gain=gain,
            rad_s_per_count=_rad_s(gain, rate_hz),
        )
    i = spec.axes.index(name)
    return AxisContext(
        name=name,
        rate_axis=rate_axis,
        present=True,
        rate_gain=spec.rate_gains[i],
        rad_s_per_count=_rad_s(spec.rate_gains[i], rate_hz),
        tilt_offset_raw=spec.tilt_offset_raw[i],
        gyro_bias_raw=spec.gyro_bias_raw[i],
    )
