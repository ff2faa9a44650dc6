"""The texts that the bench of the VHDL core reads and writes: samples, settings, results."""

import re
from collections.abc import Mapping
from dataclasses import astuple, dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hostkit.errors import EmulationError
from hostkit.fixedpoint import wrap32
from hostkit.records import Axis, read_only
from hostkit.spec import FixedPointSpec

_DIGEST = re.compile(r"[0-9a-f]{12}")
_RESULT = re.compile(r"([0-9a-f]{4}) ((?:[0-9a-f]{8} ){4})([01]) ([01]) (\d+) (\d+)")

COLUMN: dict[Axis, int] = {"roll": 0, "pitch": 1}

IntArray = NDArray[np.int64]


@dataclass(frozen=True, slots=True, kw_only=True)
class HdlSettings:
    """What may change in the core at run time, in the order of its record ``hk_settings_t``.

    Attributes
    ----------
    blend, rate_gain_roll, rate_gain_pitch, integral_gain
        Raw coefficients, in the formats of the design.
    tilt_offset_roll, tilt_offset_pitch
        Half turns.
    gyro_bias_roll, gyro_bias_pitch
        Half turns per sample; with an integral where they start, with its fraction bits.
    gate_lowest, gate_highest
        Sums of squared counts.
    """

    blend: int
    rate_gain_roll: int
    rate_gain_pitch: int
    integral_gain: int = 0
    tilt_offset_roll: int = 0
    tilt_offset_pitch: int = 0
    gyro_bias_roll: int = 0
    gyro_bias_pitch: int = 0
    gate_lowest: int = 0
    gate_highest: int = 0


def hdl_settings(spec: FixedPointSpec) -> HdlSettings:
    """Return the settings of a spec; those of an axis that it lacks do nothing."""
    gain = {axis: spec.rate_gains[i].raw for i, axis in enumerate(spec.axes)}
    offset = dict(zip(spec.axes, spec.tilt_offset_raw, strict=True))
    bias = dict(zip(spec.axes, spec.gyro_bias_raw, strict=True))
    return HdlSettings(
        blend=spec.blend.raw,
        rate_gain_roll=gain.get("roll", 0),
        rate_gain_pitch=gain.get("pitch", 0),
        integral_gain=0 if spec.integral is None else spec.integral.gain.raw,
        tilt_offset_roll=offset.get("roll", 0),
        tilt_offset_pitch=offset.get("pitch", 0),
        gyro_bias_roll=bias.get("roll", 0),
        gyro_bias_pitch=bias.get("pitch", 0),
        gate_lowest=0 if spec.gate is None else spec.gate.lowest,
        gate_highest=0 if spec.gate is None else spec.gate.highest,
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
        The hidden word of each of them, shape ``(N, 2)``; 0 where the design has none.
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
        columns = [COLUMN[axis] for axis in spec.axes]
        words = (self.angle_raw[:, columns], self.hidden_raw[:, columns])
        return np.hstack(words)[:, : len(spec.axes) + len(spec.hidden)]


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
        raw = (value & 0xFFFFFFFF for value in astuple(values))
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
    rows = np.array([_parsed_line(line) for line in lines], dtype=np.int64).reshape(-1, 9)
    return HdlRun(
        design_digest=digest,
        channel=rows[:, 0].copy(),
        angle_raw=wrap32(rows[:, 1:3]),
        hidden_raw=wrap32(rows[:, 3:5]),
        restarted=rows[:, 5] == 1,
        saturated=rows[:, 6] == 1,
        taken_cycle=rows[:, 7].copy(),
        latency_cycles=rows[:, 8].copy(),
    )


def _parsed_line(line: str) -> tuple[int, ...]:
    match = _RESULT.fullmatch(line)
    if match is None:
        raise EmulationError(f"the simulation wrote {line[:40]!r}, which is not a result")
    channel, words, *numbers = match.groups()
    return (int(channel, 16), *(int(word, 16) for word in words.split()), *map(int, numbers))
