"""What templates see of the filter's VHDL core."""

from dataclasses import dataclass

from hostkit.errors import RenderError
from hostkit.filters import FILTERS
from hostkit.filters.core import CoreFacts, CoreQuantity, HiddenPort, Latency
from hostkit.render.fpga_options import FpgaOptions
from hostkit.spec import FixedPointSpec

ANGLES = 2
LEAST_WATCHDOG_CLOCKS = 1000


@dataclass(frozen=True, slots=True, kw_only=True)
class CoreContext:
    """The core of a design by the names and ports that the system connects.

    Attributes
    ----------
    name, package
        Its entity, and the package that has its settings.
    pipelined
        Whether the entity has the generic ``PIPELINED``.
    serves_many
        Whether it can have more than one channel.
    hidden_ports, told_ports
        Ports of hidden words, and those of them that a sample's message tells.
    tells_state
        Whether it has ``state_index`` and ``state_word`` in place of such ports.
    state_words
        How many words they show.
    method, clocks, quantities
        As in :class:`hostkit.filters.core.CoreFacts`.
    last_word
        Index of the last of the words that its bench writes of a sample: angles, hidden words.
    watchdog_clocks
        How long the bench waits for a result.
    """

    name: str
    package: str
    pipelined: bool
    serves_many: bool
    hidden_ports: tuple[HiddenPort, ...]
    told_ports: tuple[HiddenPort, ...]
    tells_state: bool
    state_words: int
    method: str
    clocks: Latency
    quantities: tuple[CoreQuantity, ...]
    last_word: int
    watchdog_clocks: int


def core_facts(spec: FixedPointSpec, *, pipelined: bool = False) -> CoreFacts:
    """Return what the filter of a spec tells of its core.

    Raises
    ------
    RenderError
        If it has none, or none that is pipelined.
    """
    filter_ = FILTERS[spec.filter]
    if filter_.core is None:
        known = ", ".join(one.name for one in FILTERS if one.core is not None)
        raise RenderError(
            f"filter = {spec.filter!r}: the {filter_.title} has no VHDL core; of these there is "
            f"one: {known}"
        )
    if pipelined and not filter_.core.pipelined:
        raise RenderError(
            f"pipelined = True: the core of the {filter_.title} takes one sample at a time; "
            "leave the option out"
        )
    return filter_.core.facts(spec, pipelined)


def core_context(spec: FixedPointSpec, options: FpgaOptions) -> CoreContext:
    """Lay out the core of a design.

    Raises
    ------
    RenderError
        If the filter has no core, or an option is of a core that it does not have.
    """
    facts = core_facts(spec, pipelined=options.pipelined)
    filter_ = FILTERS[spec.filter]
    assert filter_.core is not None
    most = filter_.core.most_channels
    if options.channels > most:
        raise RenderError(
            f"channels = {options.channels}: the core of the {filter_.title} serves {most} at most"
        )
    state_words = len(spec.hidden) if spec.tells_state else 0
    hidden_words = state_words or len(facts.hidden_ports)
    return CoreContext(
        name=f"hk_{spec.filter}",
        package=f"hk_{spec.filter}_pkg",
        pipelined=filter_.core.pipelined,
        serves_many=most > 1,
        hidden_ports=facts.hidden_ports,
        told_ports=tuple(port for port in facts.hidden_ports if port.word is not None),
        tells_state=spec.tells_state,
        state_words=state_words,
        method=facts.method,
        clocks=facts.clocks,
        quantities=facts.quantities,
        last_word=ANGLES + hidden_words - 1,
        watchdog_clocks=max(LEAST_WATCHDOG_CLOCKS, 2 * facts.clocks.latency),
    )


def core_folders(filter_name: str) -> tuple[str, ...]:
    """Return the template folders that the core of a filter needs beside its own."""
    core = FILTERS[filter_name].core
    return () if core is None else core.folders
