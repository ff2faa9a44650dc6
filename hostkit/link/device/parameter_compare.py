"""The parameters of a device beside those of a file."""

from collections.abc import Sequence
from dataclasses import dataclass

from hostkit.link.device.parameter_entry import ParameterEntry
from hostkit.link.device.parameter_facts import parameter_facts
from hostkit.link.device.parameter_file import FileParameter

EQUAL_WITHIN = 1e-6
"""MAVProxy writes six places, and counts values as equal that are no farther apart."""

REAL32_RELATIVE = 2.0**-24


@dataclass(frozen=True, slots=True, kw_only=True)
class Difference:
    """A parameter whose values are not the same; None where a side does not have it."""

    name: str
    device: float | None
    file: float | None


def differences(
    entries: Sequence[ParameterEntry], rows: Sequence[FileParameter], *, missing: bool = False
) -> tuple[Difference, ...]:
    """Return what differs by more than the device or the file rounds, by name.

    Parameters
    ----------
    missing
        Whether a parameter that one side lacks is a difference.
    """
    device = {entry.name: entry.value for entry in entries}
    file = {row.name: row.value for row in rows}
    steps = {name: fact.relative_step for name, fact in parameter_facts().items()}
    names = device.keys() | file.keys() if missing else device.keys() & file.keys()
    return tuple(
        Difference(name=name, device=device.get(name), file=file.get(name))
        for name in sorted(names)
        if not _equal(device.get(name), file.get(name), steps.get(name, 0.0))
    )


def _equal(one: float | None, other: float | None, relative_step: float) -> bool:
    if one is None or other is None:
        return False
    relative = max(relative_step, REAL32_RELATIVE)
    return abs(one - other) <= EQUAL_WITHIN + relative * abs(other)
