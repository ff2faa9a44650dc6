"""The parameters of a device beside those of a file."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hostkit.errors import HostkitError
from hostkit.filters.complementary import told_by_device, with_told
from hostkit.link.parameter_entry import ParameterEntry
from hostkit.link.parameter_facts import FILTER_NAMES
from hostkit.link.parameter_file import FileParameter
from hostkit.records import FilterDesign

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
    entries: Sequence[ParameterEntry],
    rows: Sequence[FileParameter],
    design: FilterDesign | None = None,
    *,
    missing: bool = False,
) -> tuple[Difference, ...]:
    """Return what differs, by name.

    Parameters
    ----------
    design
        What the device runs. With it the values of the file are rounded as the device would.
    missing
        Whether a parameter that one side lacks is a difference.
    """
    device = {entry.name: entry.value for entry in entries}
    file = {row.name: row.value for row in rows}
    told = file if design is None else _rounded(file, design)
    names = device.keys() | file.keys() if missing else device.keys() & file.keys()
    return tuple(
        Difference(name=name, device=device.get(name), file=file.get(name))
        for name in sorted(names)
        if not _equal(device.get(name), told.get(name))
        and not _equal(device.get(name), file.get(name))
    )


def _equal(one: float | None, other: float | None) -> bool:
    if one is None or other is None:
        return False
    return abs(one - other) <= EQUAL_WITHIN + REAL32_RELATIVE * abs(other)


def _rounded(file: dict[str, float], design: FilterDesign) -> dict[str, float]:
    """Return what a device of the design tells when it was set to these values."""
    own = told_by_device(design)
    rounded = dict(file)
    for name, place in FILTER_NAMES.items():
        if name in file:
            value = float(np.float32(file[name]))
            try:
                run = with_told(design, (*own[:place], value, *own[place + 1 :]))
                rounded[name] = told_by_device(run)[place]
            except HostkitError:
                continue  # out of range: compared as it stands
    return rounded
