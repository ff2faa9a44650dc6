"""What a deliberate fault of the RTL is."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Mutation:
    """A fault: in a source, the text `good` (there once) becomes `bad`."""

    name: str
    check: str
    source: str
    good: str
    bad: str


def table(check: str, source: str, *rows: tuple[str, str, str]) -> tuple[Mutation, ...]:
    """Return faults of one source that one check must catch: name, good, bad."""
    return tuple(
        Mutation(name=name, check=check, source=source, good=good, bad=bad)
        for name, good, bad in rows
    )
