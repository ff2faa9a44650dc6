"""A parameter as a device told it, and what may be asked of it."""

import math
import re
from dataclasses import dataclass
from typing import Final

import numpy as np

from hostkit.errors import HostkitError

NEAR_RELATIVE = 1e-4
NEAR_ABSOLUTE = 2e-6
"""What a device may round a value by, and it still counts as the value that was asked for."""

_NAME: Final = re.compile(r"[!-~]{1,16}\Z")


@dataclass(frozen=True, slots=True, kw_only=True)
class ParameterEntry:
    """One parameter as the device told it.

    Attributes
    ----------
    value
        What is in use.
    index
        Its number in the device's list.
    wanted
        What it was asked to use and has not answered yet.
    error
        Why the last setting did not take, or why what it told was refused; else empty.
    """

    name: str
    value: float
    index: int
    wanted: float | None = None
    error: str = ""


def is_name(text: str) -> bool:
    """Tell whether a text can be a name: 1 to 16 printable characters without spaces."""
    return _NAME.match(text) is not None


def near(told: float, asked: float) -> bool:
    """Tell whether one value is the other, but for what a device rounds it by."""
    return math.isclose(told, asked, rel_tol=NEAR_RELATIVE, abs_tol=NEAR_ABSOLUTE)


def as_real32(name: str, value: float) -> float:
    """Return the number of 32 bits that goes over the link.

    Raises
    ------
    HostkitError
        If there is none that is finite.
    """
    with np.errstate(over="ignore"):
        number = float(np.float32(value))
    if not math.isfinite(number):
        raise HostkitError(f"{name} = {value} is no finite number of 32 bits")
    return number
