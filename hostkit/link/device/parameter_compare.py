"""The parameters of a device beside those of a file."""

from collections.abc import Sequence
from dataclasses import dataclass

from hostkit.link.device.parameter_entry import ParameterEntry
from hostkit.link.device.parameter_facts import TAU_NAME
from hostkit.link.device.parameter_file import FileParameter

EQUAL_WITHIN = 1e-6
"""MAVProxy writes six places, and counts values as equal that are no farther apart."""

REAL32_RELATIVE = 2.0**-24
BLEND_STEP_RELATIVE = 2.0**-16
"""One step of the weight that a device makes of FILT_TAU: it has 18 bits, 17 of them in use."""


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
    names = device.keys() | file.keys() if missing else device.keys() & file.keys()
    return tuple(
        Difference(name=name, device=device.get(name), file=file.get(name))
        for name in sorted(names)
        if not _equal(name, device.get(name), file.get(name))
    )


def _equal(name: str, one: float | None, other: float | None) -> bool:
    if one is None or other is None:
        return False
    relative = BLEND_STEP_RELATIVE if name == TAU_NAME else REAL32_RELATIVE
    return abs(one - other) <= EQUAL_WITHIN + relative * abs(other)
