"""How many clocks the filter of a design takes: one place for options, report and tests."""

from dataclasses import dataclass

from hostkit.spec import FixedPointSpec

ARCTAN_CLOCKS = {"roll": 29, "pitch": 54, "both": 54}
ARCSIN_CLOCKS = {"roll": 56, "pitch": 57, "both": 84}
PIPELINED_ARCTAN_CLOCKS = {"roll": 43, "pitch": 70, "both": 70}
PIPELINED_ARCSIN_CLOCKS = 71
PIPELINED_INTEGRAL_CLOCKS = 2
CHANNEL_CLOCKS = 9
"""From one sample of a channel to the next of it in the pipelined filter, without an integral."""

HAND_OVER_CLOCKS = 1
"""A result waits one clock for the next sample to be taken."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Latency:
    """Clocks of a filter.

    Attributes
    ----------
    latency
        From the edge that takes a sample to the first edge on which its result is offered.
    interval
        From one sample to the next at best.
    channel_interval
        From one sample of a channel to the next of the same channel at best.
    """

    latency: int
    interval: int
    channel_interval: int

    def samples_per_s(self, clock_hz: int) -> int:
        """Return how many samples are filtered in a second, at most."""
        return clock_hz // self.interval


def filter_latency(spec: FixedPointSpec, *, pipelined: bool = False) -> Latency:
    """Return the clocks of the filter of a design; they depend on nothing else."""
    axes = "both" if len(spec.axes) > 1 else spec.axes[0]
    arcsin = spec.tilt == "arcsin"
    if pipelined:
        clocks = PIPELINED_ARCSIN_CLOCKS if arcsin else PIPELINED_ARCTAN_CLOCKS[axes]
        more = 0 if spec.integral is None else PIPELINED_INTEGRAL_CLOCKS
        return Latency(latency=clocks + more, interval=1, channel_interval=CHANNEL_CLOCKS + more)
    clocks = (ARCSIN_CLOCKS if arcsin else ARCTAN_CLOCKS)[axes]
    if spec.integral is not None:
        clocks += 2 if arcsin and axes == "both" else 1
    interval = clocks + HAND_OVER_CLOCKS
    return Latency(latency=clocks, interval=interval, channel_interval=interval)
