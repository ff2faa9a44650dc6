"""The VHDL cores of the complementary filter: a small one, and one that takes a sample a clock."""

from hostkit.filters.complementary.spec import ComplementarySpec
from hostkit.filters.core import (
    CoreFacts,
    CoreFeature,
    CoreQuantity,
    FilterCore,
    HiddenPort,
    Latency,
    WordFormat,
)
from hostkit.fixedpoint import Coefficient
from hostkit.records import AXES, Axis

MOST_CHANNELS = 1024

ARCTAN_CLOCKS = {"roll": 30, "pitch": 54, "both": 54}
ARCSIN_CLOCKS = {"roll": 57, "pitch": 58, "both": 82}
INTEGRAL_CLOCKS = 1
HAND_OVER_CLOCKS = 1
"""A result waits one clock for the next sample to be taken."""

PIPELINED_ARCTAN_CLOCKS = {"roll": 43, "pitch": 70, "both": 70}
PIPELINED_ARCSIN_CLOCKS = 71
PIPELINED_INTEGRAL_CLOCKS = 2
CHANNEL_CLOCKS = 9
"""From a sample to the next of the same channel, which needs its result; without an integral."""


def clocks(spec: ComplementarySpec, pipelined: bool = False) -> Latency:
    """Return the clocks of the core of a design; they depend on nothing else."""
    axes = "both" if len(spec.axes) > 1 else spec.axes[0]
    arcsin, integral = spec.tilt == "arcsin", spec.integral is not None
    if pipelined:
        more = PIPELINED_INTEGRAL_CLOCKS * integral
        latency = PIPELINED_ARCSIN_CLOCKS if arcsin else PIPELINED_ARCTAN_CLOCKS[axes]
        return Latency(latency=latency + more, interval=1, channel_interval=CHANNEL_CLOCKS + more)
    latency = (ARCSIN_CLOCKS if arcsin else ARCTAN_CLOCKS)[axes] + INTEGRAL_CLOCKS * integral
    interval = latency + HAND_OVER_CLOCKS
    return Latency(latency=latency, interval=interval, channel_interval=interval)


def core_facts(spec: ComplementarySpec, pipelined: bool) -> CoreFacts:
    """Tell of the core of a design."""
    tilt = "arc sine" if spec.tilt == "arcsin" else "arc tangent"
    return CoreFacts(
        method=f"the {tilt} of the specific force and the integrated angular rate",
        clocks=clocks(spec, pipelined),
        hidden_ports=tuple(_bias_port(spec, axis) for axis in AXES["both"]),
        features=(
            CoreFeature(
                name="ARCSIN",
                present=spec.tilt == "arcsin",
                title="tilt is the arc sine of one component",
            ),
            CoreFeature(
                name="GATE",
                present=spec.gate is not None,
                title="the size of the specific force gates the correction",
            ),
            CoreFeature(
                name="INTEGRAL",
                present=spec.integral is not None,
                title="the bias of the gyroscope is estimated",
            ),
        ),
        formats=_formats(spec),
        quantities=_quantities(spec),
    )


def _bias_port(spec: ComplementarySpec, axis: Axis) -> HiddenPort:
    shown = spec.integral is not None and axis in spec.axes
    return HiddenPort(
        name=f"bias_{axis}",
        title=f"Bias of the gyroscope, {axis}, with BIAS_FRACTION_BITS.",
        word=spec.axes.index(axis) if shown else None,
    )


def _formats(spec: ComplementarySpec) -> tuple[WordFormat, ...]:
    gains = dict(zip(spec.axes, spec.rate_gains, strict=True))
    integral = spec.integral
    coefficients: tuple[tuple[str, Coefficient | None], ...] = (
        ("BLEND", spec.blend),
        *((f"RATE_GAIN_{axis.upper()}", gains.get(axis)) for axis in AXES["both"]),
        ("INTEGRAL_GAIN", None if integral is None else integral.gain),
    )
    return (
        *(
            WordFormat(
                name=name,
                fraction_bits=0 if gain is None else gain.format.fraction_bits,
                title=f"fraction bits of {name}",
            )
            for name, gain in coefficients
        ),
        WordFormat(
            name="BIAS_FRACTION_BITS",
            fraction_bits=0 if integral is None else integral.fraction_bits,
            title="fraction bits of a bias",
        ),
    )


def _quantities(spec: ComplementarySpec) -> tuple[CoreQuantity, ...]:
    bias, gains = "constant", [*spec.rate_gains, spec.blend]
    if spec.integral is not None:
        bits = spec.integral.fraction_bits
        bias = f"signed 32 bit, half turns per sample with {bits} fraction bits"
        gains.append(spec.integral.gain)
    return (
        CoreQuantity(name="bias of the gyroscope", format=bias),
        *(
            CoreQuantity(name=f"`{c.name}`", format=f"{c.format}: {c.raw} for {c.real!r} {c.unit}")
            for c in gains
        ),
    )


CORE: FilterCore[ComplementarySpec] = FilterCore(
    most_channels=MOST_CHANNELS,
    pipelined=True,
    folders=("polar",),
    facts=core_facts,
)
