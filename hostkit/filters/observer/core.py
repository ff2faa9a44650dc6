"""The VHDL core of the observer: one program, one sample at a time."""

from hostkit.filters.core import CoreFacts, FilterCore, Latency
from hostkit.filters.observer.spec import ObserverSpec

HAND_OVER_CLOCKS = 1
"""A result waits one clock for the next sample to be taken."""


def core_facts(spec: ObserverSpec, _pipelined: bool) -> CoreFacts:
    """Tell of the core of a design."""
    latency = 700
    interval = latency + HAND_OVER_CLOCKS
    return CoreFacts(
        method="the orientation that an observer of velocity follows",
        clocks=Latency(latency=latency, interval=interval, channel_interval=interval),
    )


CORE: FilterCore[ObserverSpec] = FilterCore(
    most_channels=1, pipelined=False, folders=(), facts=core_facts
)
