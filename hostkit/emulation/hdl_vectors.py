"""The texts that the bench of the VHDL core reads and writes: samples, settings, results."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hostkit.errors import EmulationError
from hostkit.filters import FILTERS
from hostkit.fixedpoint import wrap32
from hostkit.records import Axis, FilterDesign, read_only
from hostkit.spec import FixedPointSpec

_DIGEST = re.compile(r"[0-9a-f]{12}")
_RESULT = re.compile(r"([0-9a-f]{4}) ((?:[0-9a-f]{8} ){2,})([01]) ([01]) (\d+) (\d+)")

LEAST_WORDS = 7
"""Of a result without hidden words."""

COLUMN: dict[Axis, int] = {"roll": 0, "pitch": 1}

IntArray = NDArray[np.int64]


@dataclass(frozen=True, slots=True, kw_only=True)
class HdlSettings:
    """What may change in the core at run time.

    Attributes
    ----------
    names, words
        Elements of the core's record ``hk_settings_t`` in its order, and their raw values.
    """

    names: tuple[str, ...]
    words: tuple[int, ...]


def hdl_settings(design: FilterDesign, spec: FixedPointSpec) -> HdlSettings:
    """Return the settings of a spec of a design; those that it lacks do nothing."""
    settings = FILTERS[spec.filter].setting_words(design, spec)
    return HdlSettings(
        names=tuple(setting.name for setting in settings),
        words=tuple(setting.raw or 0 for setting in settings),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class HdlRun:
    """What the simulated core answered.

    Attributes
    ----------
    design_digest
        The design that is compiled into the core.
    channel
        Channel of each sample, shape ``(N,)``.
    angle_raw
        Roll and pitch in half turns, shape ``(N, 2)``; an axis that the design lacks is 0.
    hidden_raw
        The words that the core shows beside them, shape ``(N, H)``: those of its ports of hidden
        words, 0 where the design has none for it, or its whole state.
    restarted
        True where the core loaded the measured tilt instead of stepping, shape ``(N,)``.
    saturated
        True where a count stands at the end of its range, shape ``(N,)``.
    taken_cycle
        Clock at which the core took the sample, shape ``(N,)``.
    latency_cycles
        Clocks from taking a sample to offering its angles, shape ``(N,)``.
    """

    design_digest: str
    channel: IntArray
    angle_raw: IntArray
    hidden_raw: IntArray
    restarted: NDArray[np.bool_]
    saturated: NDArray[np.bool_]
    taken_cycle: IntArray
    latency_cycles: IntArray

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for array in (self.channel, self.angle_raw, self.hidden_raw, self.restarted):
            read_only(array)
        for array in (self.saturated, self.taken_cycle, self.latency_cycles):
            read_only(array)

    def state_raw(self, spec: FixedPointSpec) -> IntArray:
        """Return the states as the integer model of a design has them, shape ``(N, S)``."""
        angles = self.angle_raw[:, [COLUMN[axis] for axis in spec.axes]]
        return np.hstack([angles, self.hidden_raw[:, list(_hidden_columns(spec))]])


def _hidden_columns(spec: FixedPointSpec) -> tuple[int, ...]:
    """Return which of the words that the core shows is which hidden word of the spec."""
    if spec.tells_state:
        return tuple(range(len(spec.hidden)))
    core = FILTERS[spec.filter].core
    words = () if core is None else [port.word for port in core.facts(spec, False).hidden_ports]
    return tuple(words.index(word) for word in range(len(spec.hidden)))


def vector_text(
    channel: IntArray,
    accel_count: IntArray,
    gyro_count: IntArray,
    settings: Mapping[int, HdlSettings],
) -> str:
    """Return the bench's input; settings stand before the sample that they are keyed by.

    Raises
    ------
    EmulationError
        If a count does not fit 16 bits.
    """
    counts = np.concatenate([accel_count, gyro_count], axis=1)
    outside = (counts < -(2**15)) | (counts >= 2**15)
    if outside.any():
        raise EmulationError(f"count {counts[outside][0]} does not fit 16 bits")
    words = np.column_stack([channel, counts & 0xFFFF]).tolist()
    lines = [" ".join(f"{word:04x}" for word in row) + "\n" for row in words]
    for index, values in settings.items():
        raw = (value & 0xFFFFFFFF for value in values.words)
        lines[index] = "s " + " ".join(f"{word:08x}" for word in raw) + "\n" + lines[index]
    return "".join(lines)


def parsed_results(results: Path, samples: int) -> HdlRun:
    """Read the bench's output.

    Raises
    ------
    EmulationError
        If it is not what the bench writes for so many samples.
    """
    try:
        digest, *lines = results.read_text(encoding="ascii").splitlines()
    except (OSError, ValueError) as error:
        raise EmulationError(
            f"the simulation wrote no results that can be read: {error}"
        ) from error
    if not _DIGEST.fullmatch(digest):
        raise EmulationError(f"the simulation's results begin with {digest[:40]!r}, not a digest")
    if len(lines) != samples:
        raise EmulationError(f"the simulation wrote {len(lines)} results for {samples} samples")
    parsed = [_parsed_line(line) for line in lines]
    if len({len(row) for row in parsed}) > 1:
        raise EmulationError("the simulation's results differ in their numbers of words")
    rows = np.array(parsed, dtype=np.int64).reshape(len(lines), -1 if lines else LEAST_WORDS)
    return HdlRun(
        design_digest=digest,
        channel=rows[:, 0].copy(),
        angle_raw=wrap32(rows[:, 1:3]),
        hidden_raw=wrap32(rows[:, 3:-4]),
        restarted=rows[:, -4] == 1,
        saturated=rows[:, -3] == 1,
        taken_cycle=rows[:, -2].copy(),
        latency_cycles=rows[:, -1].copy(),
    )


def _parsed_line(line: str) -> tuple[int, ...]:
    match = _RESULT.fullmatch(line)
    if match is None:
        raise EmulationError(f"the simulation wrote {line[:40]!r}, which is not a result")
    channel, words, *numbers = match.groups()
    return (int(channel, 16), *(int(word, 16) for word in words.split()), *map(int, numbers))
