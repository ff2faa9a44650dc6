"""What a comparison knows of a filter that another package brings."""

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from importlib.metadata import PackageNotFoundError, version
from types import ModuleType
from typing import Final

import numpy as np
from numpy.typing import NDArray

from hostkit.errors import ToolMissingError

Vector = NDArray[np.float64]

Run = Callable[[Vector, Vector, float, tuple[float, ...]], Vector]
"""Angular rate (rad/s) and specific force (m/s^2) in sensor axes, each ``(N, 3)``, the period (s)
and the parameters of the peer, to orientations, sensor to earth with z up: ``(N, 4)``, w first."""

LEAST_EVALUATIONS: Final = 8
"""However slow a peer is, so many points of its parameters are tried."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PeerParameter:
    """One parameter of a peer that is tuned.

    Attributes
    ----------
    name, unit
        As the peer's own documents have them; ``"1"`` without a unit.
    default
        What the package takes if nothing is said.
    lowest, highest
        Where it is looked for; as a logarithm if `is_log`.
    """

    name: str
    unit: str
    default: float
    lowest: float
    highest: float
    is_log: bool = True


@dataclass(frozen=True, slots=True, kw_only=True)
class Peer:
    """One filter of another package.

    Attributes
    ----------
    name, title
        Its name on the command line, and for a person.
    package
        What `pip` installs it by; its name is also that of the module.
    parameters
        The main ones, which are tuned.
    run
        Runs it over a recording.
    slowness
        How much fewer evaluations its tuning gets than a fast one's.
    is_offline
        Whether it looks ahead, so that no device can run it.
    timed
        What the time of a sample is spent in.
    """

    name: str
    title: str
    package: str
    parameters: tuple[PeerParameter, ...]
    run: Run
    slowness: int = 1
    is_offline: bool = False
    timed: str

    @property
    def defaults(self) -> tuple[float, ...]:
        """Return the package's own values of the parameters."""
        return tuple(p.default for p in self.parameters)

    def evaluations(self, budget: int) -> int:
        """Return how many points its tuning may try where a fast filter may try `budget`."""
        return max(LEAST_EVALUATIONS, budget // self.slowness)

    def version(self) -> str | None:
        """Return the version of the package; None where it is not installed."""
        try:
            return version(self.package)
        except PackageNotFoundError:
            return None


def package(name: str, needed: str) -> ModuleType:
    """Import the module of a peer.

    Parameters
    ----------
    needed
        A name that the module must have: its interface has changed over the years.

    Raises
    ------
    ToolMissingError
        If it is not installed, or of another interface; the message says how to install it.
    """
    try:
        module = import_module(name)
    except ImportError as error:
        raise ToolMissingError(
            f"{name.partition('.')[0]} is not installed; it is for hostkit compare: "
            "pip install 'hostkit[compare]'"
        ) from error
    if not hasattr(module, needed):
        raise ToolMissingError(
            f"{name} is installed without {needed}; hostkit compare needs a newer one: "
            f"pip install --upgrade {name}"
        )
    return module
