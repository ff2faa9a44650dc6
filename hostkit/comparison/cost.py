"""What a sample costs: our generated C and the peers, in one process and in turns."""

import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from hostkit.comparison.calibration import readings_of
from hostkit.comparison.generated import generated_filter
from hostkit.comparison.options import CompareOptions
from hostkit.comparison.peer import Peer
from hostkit.comparison.peers import chosen_peers
from hostkit.comparison.row import Row
from hostkit.errors import HostkitError
from hostkit.filters import FILTERS
from hostkit.recordings import Recording
from hostkit.records import FilterDesign
from hostkit.render.options import Arithmetic
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import to_counts
from hostkit.tuning import TUNERS, sensor_config

Clock = Callable[[], float]
Action = Callable[[], object]

ROUNDS: Final = 7
SLOW_S: Final = 0.3
"""An action that takes longer is not repeated."""
TURN_S: Final = 5e-3
"""A turn repeats a short action for so long: the turns before it have emptied the caches."""
MOST_SAMPLES: Final = 4000
ARITHMETICS: Final[tuple[tuple[Arithmetic, str], ...]] = (
    ("fixed", "fixed point"),
    ("float", "32-bit floats"),
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Cost:
    """What a sample costs.

    Attributes
    ----------
    name, title
        Of the filter.
    timed
        What the time was spent in.
    arithmetic
        Of the generated C; None for a peer.
    ns_per_sample
        Shortest time of several turns; None where it could not be measured.
    reason
        Why not.
    """

    name: str
    title: str
    timed: str
    arithmetic: Arithmetic | None = None
    ns_per_sample: float | None
    reason: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Contender:
    name: str
    title: str
    timed: str
    samples: int
    action: Action | None
    arithmetic: Arithmetic | None = None
    reason: str = ""


def costs(
    recording: Recording, options: CompareOptions, clock: Clock = time.perf_counter
) -> tuple[Cost, ...]:
    """Time the update of our filters as generated C, and of the peers, over a recording.

    Ours reads counts; a peer reads numbers, with its defaults.

    Parameters
    ----------
    recording
        Whose first samples are run, at most 4000 of them.
    clock
        Seconds.
    """
    with tempfile.TemporaryDirectory(prefix="hostkit-") as name:
        contenders = [
            *_own(recording, options, Path(name)),
            *(_peer(peer, recording) for peer in chosen_peers(options.peers)),
        ]
        running = [one for one in contenders if one.action is not None]
        least = least_seconds([one.action for one in running if one.action], clock)
    seconds = {id(one): s for one, s in zip(running, least, strict=True)}
    return tuple(
        Cost(
            name=one.name,
            title=one.title,
            timed=one.timed,
            arithmetic=one.arithmetic,
            ns_per_sample=seconds[id(one)] / one.samples * 1e9 if id(one) in seconds else None,
            reason=one.reason,
        )
        for one in contenders
    )


def cost_of(row: Row, found: tuple[Cost, ...]) -> float | None:
    """Return nanoseconds of an update of a row's filter, in the arithmetic that was scored."""
    arithmetic: Arithmetic | None = None
    if row.origin == "hostkit":
        arithmetic = "fixed" if row.settings == "design" else "float"
    own = (c for c in found if c.name == row.name and c.arithmetic == arithmetic)
    return min((c.ns_per_sample for c in own if c.ns_per_sample is not None), default=None)


def least_seconds(actions: Sequence[Action], clock: Clock) -> tuple[float, ...]:
    """Return the shortest time of each action, in turns; a slow one is run once."""
    least = [_seconds(action, clock) for action in actions]
    for _ in range(ROUNDS):
        for i, action in enumerate(actions):
            if least[i] <= SLOW_S:
                least[i] = min(least[i], _turn(action, clock))
    return tuple(least)


def _turn(action: Action, clock: Clock) -> float:
    begun = clock()
    least = _seconds(action, clock)
    while clock() - begun < TURN_S:
        least = min(least, _seconds(action, clock))
    return least


def _seconds(action: Action, clock: Clock) -> float:
    begun = clock()
    action()
    return clock() - begun


def _own(recording: Recording, options: CompareOptions, folder: Path) -> list[_Contender]:
    designs = [options.design] if options.design else _designs(recording, options)
    return [
        one
        for design in designs
        for arithmetic, words in ARITHMETICS
        for one in _generated(design, arithmetic, words, recording, folder)
    ]


def _designs(recording: Recording, options: CompareOptions) -> list[FilterDesign]:
    return [
        FilterDesign(
            filter=tuner.name,
            axes=options.axes,
            tilt="atan2",
            mounting=options.mounting,
            rate_hz=recording.rate_hz,
            sensor=sensor_config((recording,), recording.rate_hz),
            parameters=tuner.default(),
        )
        for tuner in TUNERS
    ]


def _generated(
    design: FilterDesign, arithmetic: Arithmetic, words: str, recording: Recording, folder: Path
) -> tuple[_Contender, ...]:
    title, timed = FILTERS[design.filter].title, f"generated C, {words}"
    counts = to_counts(
        SENSORS[design.sensor.part],
        design.sensor,
        recording.angular_rate_rad_s[:MOST_SAMPLES],
        recording.specific_force_m_s2[:MOST_SAMPLES],
    )
    try:
        built = generated_filter(design, arithmetic, counts, folder / design.filter / arithmetic)
    except HostkitError as error:
        return (_absent(design.filter, title, timed, error),)
    pairs = (
        (f"{timed}, update", built.updates()),
        (f"{timed}, update and angles", built.updates_and_angles()),
    )
    return tuple(
        _Contender(
            name=design.filter,
            title=title,
            timed=text,
            samples=len(counts),
            action=action,
            arithmetic=arithmetic,
        )
        for text, action in pairs
    )


def _peer(peer: Peer, recording: Recording) -> _Contender:
    whole = readings_of(recording)
    rate, force = whole.rate_rad_s[:MOST_SAMPLES], whole.force_m_s2[:MOST_SAMPLES]
    samples = len(rate)

    def run(count: int = samples) -> object:
        return peer.run(rate[:count], force[:count], whole.period_s, peer.defaults)

    try:
        run(min(samples, 100))
    except HostkitError as error:
        return _absent(peer.name, peer.title, peer.timed, error)
    return _Contender(
        name=peer.name, title=peer.title, timed=peer.timed, samples=samples, action=run
    )


def _absent(name: str, title: str, timed: str, error: HostkitError) -> _Contender:
    return _Contender(
        name=name, title=title, timed=timed, samples=0, action=None, reason=str(error)
    )
