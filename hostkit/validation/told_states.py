"""States that a device told, put to the samples that they belong to."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

from hostkit.trace import ToldState
from hostkit.validation.order import COUNTER, WINDOW

AHEAD = 64
"""How far before its sample a state may come, in samples: no link disturbs the order more."""

MOST_DUE = 8
"""States that wait for their sample; a device tells one now and then, a hostile one any number."""

MOST_LATE = 4
"""States of samples that were passed, of those that come at once: each may cost many steps."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SortedOut:
    """States that are not those of the samples that came with them.

    Attributes
    ----------
    late
        Those of samples that were passed lately, the last few.
    wrong
        How many are of no sample at all.
    """

    late: tuple[ToldState, ...]
    wrong: int


class ToldStates:
    """Keeps states until it is known which sample they are of, in bounded memory."""

    def __init__(self) -> None:
        self._due: list[ToldState] = []
        self._now: dict[int, tuple[int, ...]] = {}

    def of(self, sequence: int) -> tuple[int, ...] | None:
        """Return what was told of a sample of the trace that was sorted last."""
        return self._now.get(sequence)

    def sort(
        self,
        told: Sequence[ToldState],
        sequence: Sequence[int],
        recent: Collection[int],
        *,
        anew: bool,
    ) -> SortedOut:
        """Take the states that came with some samples.

        What belongs to none waits for the next sample, for the device may begin anew with it;
        after that it is wrong, unless its sample was lost, left out, or is just ahead.

        Parameters
        ----------
        told
            The states.
        sequence, recent
            Counters of the samples, and of samples that were passed lately.
        anew
            Whether the counter began anew with the first sample.
        """
        here = set(sequence)
        earlier = [replace(state, behind=0) for state in self._due]
        self._due, self._now = [], {}
        late, wrong = [], 0
        for state in (*earlier, *told):
            if state.sequence in here:
                self._now[state.sequence] = state.words_raw
            elif state.sequence in recent:
                late.append(state)
            elif state.behind == len(sequence):
                self._due.append(state)
            elif not (anew and state.behind == 0):
                wrong += self._keep_or_count(state, sequence[-1])
        surplus = max(0, len(self._due) - MOST_DUE)
        self._due = self._due[surplus:]
        return SortedOut(late=tuple(late[-MOST_LATE:]), wrong=wrong + surplus)

    def _keep_or_count(self, state: ToldState, newest: int) -> int:
        """Keep a state whose sample is just ahead; return 1 for one that can have no sample."""
        ahead = (state.sequence - newest) % COUNTER
        if 0 < ahead <= AHEAD:
            self._due.append(state)
            return 0
        return int((newest - state.sequence) % COUNTER > WINDOW)
