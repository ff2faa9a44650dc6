"""Stopwatches. Contenders take turns, so that a change of the machine's speed hits them all."""

import statistics
import time
from collections.abc import Callable, Sequence

Action = Callable[[], object]

REPETITIONS = 5
TURN_S = 2e-3
"""A turn repeats a short action for so long: the turns before it have emptied the caches."""


def seconds(action: Action) -> float:
    """Return how long an action takes."""
    begun = time.perf_counter()
    action()
    return time.perf_counter() - begun


def turn(action: Action, turn_s: float = TURN_S) -> float:
    """Return the shortest time of an action in one turn, which repeats it for so long, s."""
    begun = time.perf_counter()
    least = seconds(action)
    while time.perf_counter() - begun < turn_s:
        least = min(least, seconds(action))
    return least


def least_seconds(
    actions: Sequence[Action],
    *,
    budget_s: float,
    least: int = REPETITIONS,
    turn_s: float = TURN_S,
) -> tuple[float, ...]:
    """Return the shortest time of each action, in turns, after one round that does not count.

    Parameters
    ----------
    budget_s
        Rounds are added until so much time is spent, s, but at least `least` rounds.
    turn_s
        How long a turn repeats its action, s.
    """
    for action in actions:
        action()
    rounds: list[tuple[float, ...]] = []
    begun = time.perf_counter()
    while len(rounds) < least or time.perf_counter() - begun < budget_s:
        rounds.append(tuple(turn(action, turn_s) for action in actions))
    return tuple(min(times) for times in zip(*rounds, strict=True))


def ratio(ours: Action, peer: Action) -> float:
    """Return the median of the pairwise ratio of times, ours over the peer's."""
    ours(), peer()
    return statistics.median(seconds(ours) / seconds(peer) for _ in range(REPETITIONS))
