"""How many clocks the filter of a design takes: one place for options, report and tests."""

from dataclasses import dataclass

from hostkit.spec import FixedPointSpec

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


@dataclass(frozen=True, slots=True, kw_only=True)
class Latency:
    """Clocks of a filter.

    Attributes
    ----------
    latency
        From the edge that takes a sample to the first edge on which its result is offered; a
        pipeline that has to wait for the sample before of the same channel takes longer.
    interval
        From one sample to the next at best.
    channel_interval
        From one sample to the next of the same channel at best.
    """

    latency: int
    interval: int
    channel_interval: int

    def samples_per_s(self, clock_hz: int) -> int:
        """Return how many samples are filtered in a second, at most."""
        return clock_hz // self.interval

    def most_channels(self, clock_hz: int, rate_hz: float) -> int:
        """Return how many sensors of a rate are filtered, at most."""
        if rate_hz * self.channel_interval > clock_hz:
            return 0
        return int(self.samples_per_s(clock_hz) // rate_hz)


def filter_latency(spec: FixedPointSpec, *, pipelined: bool = False) -> Latency:
    """Return the clocks of the filter of a design; they depend on nothing else."""
    axes = "both" if len(spec.axes) > 1 else spec.axes[0]
    arcsin, integral = spec.tilt == "arcsin", spec.integral is not None
    if pipelined:
        more = PIPELINED_INTEGRAL_CLOCKS * integral
        clocks = PIPELINED_ARCSIN_CLOCKS if arcsin else PIPELINED_ARCTAN_CLOCKS[axes]
        return Latency(latency=clocks + more, interval=1, channel_interval=CHANNEL_CLOCKS + more)
    clocks = (ARCSIN_CLOCKS if arcsin else ARCTAN_CLOCKS)[axes] + INTEGRAL_CLOCKS * integral
    interval = clocks + HAND_OVER_CLOCKS
    return Latency(latency=clocks, interval=interval, channel_interval=interval)
