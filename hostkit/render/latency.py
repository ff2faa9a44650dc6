"""How many clocks the filter of a design takes: one place for options, report and tests."""

from dataclasses import dataclass

from hostkit.spec import FixedPointSpec

ARCTAN_CLOCKS = {"roll": 30, "pitch": 54, "both": 54}
ARCSIN_CLOCKS = {"roll": 57, "pitch": 58, "both": 82}
INTEGRAL_CLOCKS = 1
HAND_OVER_CLOCKS = 1
"""A result waits one clock for the next sample to be taken."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Latency:
    """Clocks of a filter.

    Attributes
    ----------
    latency
        From the edge that takes a sample to the first edge on which its result is offered; 0 where
        it is not stated.
    interval
        From one sample to the next at best.
    """

    latency: int
    interval: int

    def samples_per_s(self, clock_hz: int) -> int:
        """Return how many samples are filtered in a second, at most."""
        return clock_hz // self.interval


def filter_latency(spec: FixedPointSpec, *, pipelined: bool = False) -> Latency:
    """Return the clocks of the filter of a design; they depend on nothing else."""
    if pipelined:
        return Latency(latency=0, interval=1)
    axes = "both" if len(spec.axes) > 1 else spec.axes[0]
    clocks = (ARCSIN_CLOCKS if spec.tilt == "arcsin" else ARCTAN_CLOCKS)[axes]
    if spec.integral is not None:
        clocks += INTEGRAL_CLOCKS
    return Latency(latency=clocks, interval=clocks + HAND_OVER_CLOCKS)
