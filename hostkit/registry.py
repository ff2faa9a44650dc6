"""Named parts (sensors, filters, targets): one lookup, one error for an unknown name."""

from collections.abc import Iterable, Iterator
from importlib.metadata import entry_points
from typing import Generic, Protocol, TypeVar

from hostkit.errors import HostkitError


class Named(Protocol):
    """Anything with a name."""

    @property
    def name(self) -> str:
        """Name by which the part is asked for."""


T = TypeVar("T", bound=Named)


class Registry(Generic[T]):
    """Parts of one kind by name, ours first, then those of other distributions.

    Parameters
    ----------
    kind
        What the parts are, in the singular, for messages.
    parts
        The parts that hostkit brings.

    Notes
    -----
    Other distributions add parts through the entry-point group ``hostkit.<kind>s``.

    Raises
    ------
    HostkitError
        If two parts have one name, or if a name is not known.
    """

    def __init__(self, kind: str, parts: Iterable[T]) -> None:
        self.kind = kind
        self._parts: dict[str, T] = {}
        for part in parts:
            self._add(part)
        for point in entry_points(group=f"hostkit.{kind}s"):
            self._add(point.load())

    def _add(self, part: T) -> None:
        if part.name in self._parts:
            raise HostkitError(f"two parts are called {self.kind} {part.name!r}; names are unique")
        self._parts[part.name] = part

    def __getitem__(self, name: str) -> T:
        """Return the part called `name`."""
        try:
            return self._parts[name]
        except KeyError:
            known = ", ".join(self.names())
            raise HostkitError(f"no {self.kind} is called {name!r}; known are: {known}") from None

    def __iter__(self) -> Iterator[T]:
        return iter(self._parts.values())

    def names(self) -> tuple[str, ...]:
        """Return the known names in the order of registration."""
        return tuple(self._parts)
