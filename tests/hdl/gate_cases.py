"""Configurations of the core that are synthesised, and what they must answer."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from designs import all_parameters, design
from hdl_cases import count_vectors, option_vectors
from numpy.typing import NDArray

from hostkit.emulation import ghdl
from hostkit.filters.complementary import lower, run_integer
from hostkit.records import AXES, FilterDesign
from hostkit.render import render_target, write
from hostkit.synthesis.netlist import GateRun
from hostkit.targets import TARGETS

IntArray = NDArray[np.int64]

TOP = "hk_complementary_fixed"
FULL_COUNTS = (-32768, -32767, 32767)
"""A count of these stands at the end of its range."""
NEAR_THE_END = (*FULL_COUNTS, -32766, 32766)


@dataclass(frozen=True, slots=True, kw_only=True)
class Configuration:
    """A design, the generics of its core, and its budget: LUT, flip-flops, multipliers, RAM."""

    name: str
    design: FilterDesign
    channels: int = 1
    pipelined: bool = False
    budget: tuple[int, int, int, int]
    generics: dict[str, int | bool] = field(init=False)

    def __post_init__(self) -> None:
        generics = {"CHANNELS": self.channels, "PIPELINED": self.pipelined}
        object.__setattr__(self, "generics", generics)


CONFIGURATIONS = (
    Configuration(name="two axes", design=design(), budget=(1300, 450, 2, 0)),
    Configuration(name="every parameter", design=all_parameters(), budget=(1900, 650, 2, 0)),
    Configuration(
        name="two axes, 64 channels", design=design(), channels=64, budget=(1600, 450, 2, 2)
    ),
    Configuration(
        name="pipelined",
        design=design(axes="roll"),
        channels=4,
        pipelined=True,
        budget=(2500, 3200, 4, 4),
    ),
)


def generate(built: FilterDesign, folder: Path) -> Path:
    """Write the VHDL of a design."""
    write(render_target(built, TARGETS["spartan3adsp"]), folder)
    return folder


def vectors(configuration: Configuration, samples: int) -> IntArray:
    """Return channel and counts, shape ``(samples, 7)``; the channels take turns at random."""
    rng = np.random.default_rng(47)
    counts = np.hstack(count_vectors())
    if len(configuration.design.parameters) > 1:
        counts = np.hstack(option_vectors(configuration.design))
    ends = np.full((len(NEAR_THE_END), 6), 1000)
    ends[np.arange(len(ends)), np.arange(len(ends)) % 6] = NEAR_THE_END
    chosen = np.vstack([counts[rng.permutation(len(counts))[: samples - len(ends)]], ends])
    used = min(configuration.channels, max(1, samples // 4))
    ids = rng.choice(configuration.channels, used, replace=False)
    return np.hstack([rng.choice(ids, (samples, 1)), chosen])


def expected(built: FilterDesign, played: IntArray) -> tuple[IntArray, NDArray[np.bool_]]:
    """Return state and restarted as the integer model gives them, each channel by itself."""
    states = np.zeros((len(played), 4), dtype=np.int64)
    restarted = np.zeros(len(played), dtype=np.bool_)
    columns = [ghdl.COLUMN[axis] for axis in AXES[built.axes]]
    columns += [2 + column for column in columns]
    for channel in np.unique(played[:, 0]):
        rows = np.flatnonzero(played[:, 0] == channel)
        found = run_integer(lower(built), played[rows, 1:4], played[rows, 4:])
        states[np.ix_(rows, columns[: found.shape[1]])] = found
        restarted[rows[0]] = True
    return states, restarted


def assert_equal(run: GateRun, configuration: Configuration, played: IntArray) -> None:
    """Hold a run against the integer model."""
    states, restarted = expected(configuration.design, played)
    np.testing.assert_array_equal(run.channel, played[:, 0])
    np.testing.assert_array_equal(run.state_raw, states)
    np.testing.assert_array_equal(run.restarted, restarted)
    np.testing.assert_array_equal(run.saturated, np.isin(played[:, 1:], FULL_COUNTS).any(axis=1))
