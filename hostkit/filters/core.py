"""What a filter tells of its VHDL core, so that one FPGA system fits around any of them."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

from hostkit.spec import FixedPointSpec

SpecT = TypeVar("SpecT", bound=FixedPointSpec)


@dataclass(frozen=True, slots=True, kw_only=True)
class Latency:
    """Clocks of a core.

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


@dataclass(frozen=True, slots=True, kw_only=True)
class HiddenPort:
    """A port of 32 bits that shows a hidden word of the state next to the angles.

    Attributes
    ----------
    name
        Of the port.
    title
        What it shows, a sentence.
    word
        Which hidden word of the design's spec it is; None where the design has none for it.
    """

    name: str
    title: str
    word: int | None


@dataclass(frozen=True, slots=True, kw_only=True)
class CoreFeature:
    """Something that a core has or lacks: name, whether the design has it, and what it is."""

    name: str
    present: bool
    title: str


@dataclass(frozen=True, slots=True, kw_only=True)
class WordFormat:
    """Fraction bits of a word that registers show or set, under the name of a register's field."""

    name: str
    fraction_bits: int
    title: str


@dataclass(frozen=True, slots=True, kw_only=True)
class CoreQuantity:
    """A row of the table of formats that a person reads."""

    name: str
    format: str


@dataclass(frozen=True, slots=True, kw_only=True)
class CoreFacts:
    """The core of one design.

    Attributes
    ----------
    method
        What the angles are made from, to follow the word "from".
    clocks
        Latency and interval; they depend on nothing but the design.
    hidden_ports
        Where the core shows hidden words beside the angles. One that tells its state has none:
        it has the ports ``state_index`` and ``state_word``.
    features, formats
        What software can read of it in the registers of constants.
    quantities
        Formats for people, after those of counts and angles.
    """

    method: str
    clocks: Latency
    hidden_ports: tuple[HiddenPort, ...] = ()
    features: tuple[CoreFeature, ...] = ()
    formats: tuple[WordFormat, ...] = ()
    quantities: tuple[CoreQuantity, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class FilterCore(Generic[SpecT]):
    """The VHDL core of a filter.

    Attributes
    ----------
    most_channels
        Sensors that one core can serve by taking turns.
    pipelined
        Whether there is one, too, that takes a sample every clock; it is chosen by the generic
        ``PIPELINED``, which a core without it does not have.
    folders
        Template folders that it needs beside its own and those of the target.
    facts
        The core of a design; True asks for the pipelined one.
    """

    most_channels: int
    pipelined: bool
    folders: tuple[str, ...]
    facts: Callable[[SpecT, bool], CoreFacts]
