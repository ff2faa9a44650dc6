"""The VHDL core of the observer: a program on one multiplier, one sample at a time."""

from hostkit.filters.core import (
    CoreFacts,
    CoreFeature,
    CoreQuantity,
    FilterCore,
    Latency,
    WordFormat,
)
from hostkit.filters.observer.lowering import gain_bits
from hostkit.filters.observer.spec import ObserverSpec

STEP_CLOCKS = 373
"""Of a sample without any of the parts below, angles included; the first sample takes less."""

REST_CLOCKS, ALIGN_CLOCKS, CLIP_CLOCKS, LEAD_CLOCKS = 166, 51, 35, 53
HAND_OVER_CLOCKS = 1
"""A result waits one clock for the next sample to be taken."""


def clocks(spec: ObserverSpec) -> Latency:
    """Return the clocks of the core of a design; they depend on nothing else."""
    clips = spec.clip_count is not None
    latency = (
        STEP_CLOCKS
        + REST_CLOCKS * (spec.rest is not None)
        + ALIGN_CLOCKS * (spec.start_gain > 0 or clips)
        + CLIP_CLOCKS * clips
        + LEAD_CLOCKS * (spec.lead_raw != 0)
    )
    interval = latency + HAND_OVER_CLOCKS
    return Latency(latency=latency, interval=interval, channel_interval=interval)


def core_facts(spec: ObserverSpec, _pipelined: bool) -> CoreFacts:
    """Tell of the core of a design."""
    return CoreFacts(
        method="an orientation that the angular rate turns and a bounded velocity corrects",
        clocks=clocks(spec),
        features=(
            CoreFeature(
                name="ALIGN", present=spec.start_gain > 0, title="the first samples align it"
            ),
            CoreFeature(name="REST", present=spec.rest is not None, title="it looks for rest"),
            CoreFeature(
                name="CLIP",
                present=spec.clip_count is not None,
                title="a rate that is clipped makes it align again",
            ),
            CoreFeature(name="LEAD", present=spec.lead_raw != 0, title="the angles are told ahead"),
        ),
        formats=_formats(spec),
        quantities=_quantities(spec),
    )


def _formats(spec: ObserverSpec) -> tuple[WordFormat, ...]:
    names = ("KT", "KV", "KB", "BIAS")
    bits = (*gain_bits(spec.formats), spec.formats.bias)
    return tuple(
        WordFormat(
            name=f"{name}_FRACTION_BITS", fraction_bits=count, title=f"fraction bits of {name}"
        )
        for name, count in zip(names, bits, strict=True)
    )


def _quantities(spec: ObserverSpec) -> tuple[CoreQuantity, ...]:
    formats = spec.formats
    words = (
        ("orientation", "quaternion", 30),
        ("correction of a sample, half-angle", "rad", formats.correction),
        ("bias of the gyroscope, half-angle of a sample", "rad", formats.bias),
        ("specific force", "m/s^2", formats.force),
    )
    return tuple(
        CoreQuantity(name=name, format=f"signed 32 bit, {unit} with {bits} fraction bits")
        for name, unit, bits in words
    )


CORE: FilterCore[ObserverSpec] = FilterCore(
    most_channels=1, pipelined=False, folders=(), facts=core_facts
)
