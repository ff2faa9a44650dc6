"""What `tune` needs of a filter: which parameters can be searched, and its cost on recordings."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from hostkit.recordings import LargeRecording, Recording
from hostkit.records import Parameter
from hostkit.tuning.dimension import FreeName, SearchRange
from hostkit.tuning.options import TuningOptions
from hostkit.tuning.task import Task

AnyRecording = Recording | LargeRecording


@dataclass(frozen=True, slots=True, kw_only=True)
class Tunable:
    """One kind of parameter that can be searched or fixed.

    Attributes
    ----------
    search
        Its name, and where it is looked for.
    shown_unit, shown_per_unit
        Unit on the screen, and the factor to it from the unit of a design.
    axes
        The axes that have one of their own; empty where all have it in common.
    """

    search: SearchRange
    shown_unit: str = ""
    shown_per_unit: float = 1.0
    axes: tuple[str, ...] = ()

    @property
    def name(self) -> FreeName:
        """Name of the kind."""
        return self.search.name


@dataclass(frozen=True, slots=True, kw_only=True)
class Tuner:
    """The tuning of one filter.

    Attributes
    ----------
    name
        Name of the filter.
    tunables
        What can be searched or fixed.
    key
        Name in a design of a kind of parameter, and of an axis where it has several.
    free
        What is searched if nothing is said.
    default
        The parameters of a design that was not tuned.
    task
        Lays recordings of one rate out for the search; large ones in the folder.
    """

    name: str
    tunables: tuple[Tunable, ...]
    key: Callable[[FreeName, str | None], str]
    free: tuple[FreeName, ...]
    default: Callable[[], tuple[Parameter, ...]]
    task: Callable[[tuple[AnyRecording, ...], TuningOptions, Path], Task]

    def tunable(self, name: FreeName) -> Tunable | None:
        """Return one kind of parameter, or None where the filter does not have it."""
        return next((t for t in self.tunables if t.name == name), None)
