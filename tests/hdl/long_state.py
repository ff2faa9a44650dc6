"""A stand-in filter whose state is long: each word adds a count and its settings every sample."""

from dataclasses import dataclass
from pathlib import Path

import designs
import numpy as np
import pytest
from numpy.typing import NDArray

from hostkit.filters import FILTERS
from hostkit.filters.arctan import arctan_table
from hostkit.filters.core import CoreFacts, FilterCore, Latency
from hostkit.filters.filter import Filter, RunTime, SettingWord
from hostkit.fixedpoint import wrap32
from hostkit.records import FilterDesign
from hostkit.render import templates
from hostkit.render.environment import template_root
from hostkit.spec import FixedPointSpec, StateWord

IntArray = NDArray[np.int64]

NAME = "stand_in"
HERE = Path(__file__).with_name(NAME)
LEAST_WORDS, MOST_WORDS = 3, 24


@dataclass(frozen=True, slots=True, kw_only=True)
class StandInSpec(FixedPointSpec):
    gain: int
    offset: int
    limit: int

    @property
    def last_word(self) -> int:
        return len(self.hidden) - 1

    @property
    def step(self) -> int:
        return self.gain + self.offset + self.limit


def design(words: int = 17) -> FilterDesign:
    """Return a design; the number of words is taken from the rate."""
    own = designs.design(rate_hz=RATES_HZ[words], accel_full_scale_g=4)
    return FilterDesign(
        filter=NAME,
        axes="both",
        tilt="atan2",
        mounting=own.mounting,
        rate_hz=own.rate_hz,
        sensor=own.sensor,
        parameters=own.parameters,
    )


RATES_HZ = {LEAST_WORDS: 100.0, 17: 25.0, MOST_WORDS: 50.0}


def lower(source: FilterDesign) -> StandInSpec:
    words = next(words for words, rate_hz in RATES_HZ.items() if rate_hz == source.rate_hz)
    return StandInSpec(
        filter=NAME,
        axes=("roll", "pitch"),
        mounting=source.mounting,
        arctan=arctan_table(),
        gravity_count=8192,
        hidden=tuple(StateWord(name=f"word_{i}", unit="1", per_unit=1.0) for i in range(words)),
        error_bound_rad=1.0,
        error_per_closed_sample_rad=0.0,
        gain=-70_001,
        offset=-3,
        limit=40_000,
    )


def run_integer(
    spec: StandInSpec, accel: IntArray, gyro: IntArray, start: IntArray | None = None
) -> IntArray:
    counts = np.hstack([accel, gyro])[:, np.arange(len(spec.hidden)) % 6] + spec.step
    first = 0 if start is None else start[2:]
    words = wrap32(np.cumsum(counts, axis=0) + first)
    return np.hstack([words[:, :2], words])


def step_integer(spec: StandInSpec, states: IntArray, accel: IntArray, gyro: IntArray) -> IntArray:
    rows = zip(states, accel, gyro, strict=True)
    return np.vstack([run_integer(spec, a[None], g[None], s) for s, a, g in rows])


def run_float(
    source: FilterDesign,
    rate_rad_s: NDArray[np.float64],
    force_g: NDArray[np.float64],
    start: NDArray[np.float64] | None = None,
) -> NDArray[np.float64]:
    return np.zeros((len(rate_rad_s), 2))


def setting_words(source: FilterDesign, spec: StandInSpec) -> tuple[SettingWord, ...]:
    return tuple(
        SettingWord(
            name=name,
            title=f"{name} of the stand-in",
            raw=raw,
            width=width,
            signed=signed,
            unit="1",
            to_raw=float,
            to_value=float,
        )
        for name, raw, width, signed in (
            ("gain", spec.gain, 18, True),
            ("offset", spec.offset, 32, True),
            ("limit", spec.limit, 16, False),
        )
    )


def core_facts(spec: StandInSpec, pipelined: bool) -> CoreFacts:
    clocks = len(spec.hidden) + 1
    return CoreFacts(
        method="nothing but sums",
        clocks=Latency(latency=clocks, interval=clocks + 1, channel_interval=clocks + 1),
    )


STAND_IN: Filter[StandInSpec] = Filter(
    name=NAME,
    title="stand-in",
    lower=lower,
    run_float=run_float,
    run_integer=run_integer,
    step_integer=step_integer,
    run_time=RunTime(known=(), parameters=lambda _: (), with_told=lambda source, _: source),
    facts=lambda _: (),
    response=lambda _, hz: (np.ones(len(hz)) + 0j, np.ones(len(hz)) + 0j),
    context=lambda _, spec: spec,
    setting_words=setting_words,
    core=FilterCore(most_channels=1, pipelined=False, folders=(), facts=core_facts),
)


def register(monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    """Make the filter known, and its templates stand among ours."""
    monkeypatch.setitem(FILTERS._parts, NAME, STAND_IN)
    for own in template_root("fpga").iterdir():
        (folder / own.name).symlink_to(own)
    (folder / NAME).symlink_to(HERE)
    monkeypatch.setattr(templates, "template_root", lambda _: folder)
