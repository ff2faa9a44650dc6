"""What templates see of the parameters that a device can change while it runs."""

from dataclasses import dataclass

from hostkit.filters.complementary.lowering import bias_unit_rad_s
from hostkit.filters.complementary.run_time import RUN_TIME, limits
from hostkit.filters.complementary.spec import ComplementarySpec
from hostkit.filters.factor import FactorContext, factor
from hostkit.literals import float32_text
from hostkit.records import FilterDesign
from hostkit.units import RAD_PER_HALF_TURN_LSB


@dataclass(frozen=True, slots=True, kw_only=True)
class RangeOfValues:
    """Lowest and highest value of a parameter, as C99 hexadecimal text and as a number."""

    lowest: str
    highest: str
    shown_lowest: float
    shown_highest: float


@dataclass(frozen=True, slots=True, kw_only=True)
class RunTimeContext:
    """Limits of the parameters and factors between their values and integers.

    Attributes
    ----------
    period_s
        Sample period, C99 hexadecimal text.
    tau, bias, offset
        What a device takes, in s, rad/s and rad.
    bias_raw, bias_rad_s
        Units per rad/s, and rad/s per unit; with an integral the unit has its fraction bits.
    offset_raw, offset_rad
        Units per rad, and rad per unit.
    """

    period_s: str
    tau: RangeOfValues
    bias: RangeOfValues
    offset: RangeOfValues
    bias_raw: FactorContext
    bias_rad_s: FactorContext
    offset_raw: FactorContext
    offset_rad: FactorContext


def run_time_context(design: FilterDesign, spec: ComplementarySpec) -> RunTimeContext:
    """Lay out what the code needs to change parameters."""
    tau, bias, offset = (_range(kind, design) for kind in ("tau", "gyro_bias", "tilt_offset"))
    unit = bias_unit_rad_s(design, spec.integral)
    return RunTimeContext(
        period_s=float32_text(design.period_s),
        tau=tau,
        bias=bias,
        offset=offset,
        bias_raw=factor(1.0 / unit),
        bias_rad_s=factor(unit),
        offset_raw=factor(1.0 / RAD_PER_HALF_TURN_LSB),
        offset_rad=factor(RAD_PER_HALF_TURN_LSB),
    )


def _range(kind: str, design: FilterDesign) -> RangeOfValues:
    item = next(item for item in RUN_TIME if item.kind == kind)
    lowest, highest = limits(item, design.period_s)
    return RangeOfValues(
        lowest=float32_text(lowest),
        highest=float32_text(highest),
        shown_lowest=lowest,
        shown_highest=highest,
    )
