"""Getting the whole list of parameters over a link that loses some of it."""

from dataclasses import dataclass, field

MOST_PARAMETERS = 256
"""More than that no device of ours has; a list that claims more is not taken."""

FIRST_WAIT_S = 1.0
GAP_WAIT_S = 0.4
"""How long after the latest new number the missing ones are asked for."""

TRIES = 5
"""Requests in a row that may bring nothing new."""

BURST = 4
"""Numbers that are asked for at once: the receive queue of a small board holds no more."""

WHOLE_LIST: tuple[int, ...] = ()


@dataclass(slots=True)
class Listing:
    """Which numbers of a list have come, and what to ask for next.

    Attributes
    ----------
    count
        How many there are, as the device says; None while it has not said so.
    error
        Why the list was given up; empty while it was not.
    """

    count: int | None = None
    error: str = ""
    _seen: set[int] = field(default_factory=set)
    _due_s: float | None = None
    _tries: int = 0

    @property
    def complete(self) -> bool:
        """Tell whether every number has come."""
        return self.count is not None and len(self._seen) == self.count

    @property
    def active(self) -> bool:
        """Tell whether something is still waited for."""
        return self._due_s is not None

    def begin(self, now_s: float) -> None:
        """Start over; the first request is due at once."""
        self.count, self.error, self._tries = None, "", 0
        self._seen.clear()
        self._due_s = now_s

    def take(self, index: int, count: int, now_s: float) -> None:
        """Take the number of a parameter that came, and how many there are."""
        if not 0 < count <= MOST_PARAMETERS:
            self._give_up(f"the device says that it has {count} parameters, not 1 to 256")
            return
        if self.count != count:
            self.count = count
            self._seen = {seen for seen in self._seen if seen < count}
        if not 0 <= index < count or index in self._seen:
            return
        self._seen.add(index)
        self._tries = 0
        if self.complete:
            self._due_s = None
        elif self.active:
            self._due_s = now_s + GAP_WAIT_S

    def due(self, now_s: float) -> tuple[int, ...] | None:
        """Return the numbers to ask for now, WHOLE_LIST for all, None for nothing."""
        if self._due_s is None or now_s < self._due_s:
            return None
        if self._tries == TRIES:
            self._give_up(self._what_is_missing())
            return None
        self._tries += 1
        if self.count is None:
            self._due_s = now_s + FIRST_WAIT_S
            return WHOLE_LIST
        self._due_s = now_s + GAP_WAIT_S
        return tuple(i for i in range(self.count) if i not in self._seen)[:BURST]

    def _give_up(self, error: str) -> None:
        if self.active:
            self.error = error
        self._due_s = None

    def _what_is_missing(self) -> str:
        if self.count is None:
            return f"the device did not answer {TRIES} requests for its parameters"
        return (
            f"{self.count - len(self._seen)} of {self.count} parameters were not told, "
            f"asked for {TRIES} times"
        )
