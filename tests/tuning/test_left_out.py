"""Leaving out: what is scored must not have been tuned on, and what is usual decides a tie."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np
import pytest
from numpy.typing import NDArray

from hostkit.records import Objective, Parameter
from hostkit.tuning import TuningOptions
from hostkit.tuning.archive import archived
from hostkit.tuning.dimension import Dimension
from hostkit.tuning.retuning import SINGLE_FOLDS, cross_validate, retune
from hostkit.tuning.task import Search, SearchPlan, Task

Vector = NDArray[np.float64]

BLOCK = 10
"""Samples of a part of a recording; 80 parts."""
PARTS = 80


@dataclass(frozen=True)
class Line:
    """The box of one number between 0 and 1."""

    dimensions: tuple[Dimension, ...] = (
        Dimension(name="x", axis=None, lower=0.0, upper=1.0, is_log=False),
    )
    lower: Vector = field(default_factory=lambda: np.zeros(1))
    upper: Vector = field(default_factory=lambda: np.ones(1))

    def design_parameters(self, x: Vector) -> tuple[Parameter, ...]:
        return ()


@dataclass(frozen=True)
class Targets:
    """A task whose error at every sample is the distance to a target, ``(R, samples)``."""

    wanted: Vector
    usual: Callable[[Vector], Vector] = lambda points: np.ones(len(points))
    space: Line = field(default_factory=Line)
    objective: Objective = "rmse"
    jobs: int = 1
    is_dear: bool = False

    @property
    def lengths(self) -> tuple[int, ...]:
        return (self.wanted.shape[1],) * len(self.wanted)

    def with_jobs(self, jobs: int) -> "Targets":
        return self

    def quick_search(self, plan: SearchPlan) -> Search | None:
        return None

    def preference(self, points: Vector) -> Vector:
        return self.usual(points)

    def cost(self, points: Vector) -> Vector:
        raise AssertionError("not asked for")

    def metric(self, sums: Vector, counts: Vector) -> Vector:
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.sqrt(sums / counts)

    def block_sums(self, points: Vector, blocks: int) -> Vector:
        parts = self.wanted.reshape(len(self.wanted), 1, blocks, -1, 1)
        return np.asarray(((parts - points[:, 0]) ** 2).sum(axis=3))

    def block_counts(self, blocks: int) -> Vector:
        return np.full((len(self.wanted), 1, blocks), self.wanted.shape[1] / blocks)

    def rms_rad(self, x: Vector, recording: int, begin: int = 0, end: int | None = None) -> float:
        return float(np.sqrt(np.mean((self.wanted[recording, begin:end] - x) ** 2)))

    def errors(self, x: Vector, recording: int) -> Iterator[tuple[NDArray[np.bool_], Vector]]:
        raise AssertionError("not asked for")


def kept(task: Targets) -> Task:
    """The task with the sums of some points."""
    found = archived(task, 16)
    found.cost(np.linspace(0.0, 1.0, 101)[:, np.newaxis])
    return found


@pytest.mark.parametrize("made", [lambda task: task, kept], ids=["searched", "visited"])
def test_a_recording_is_not_tuned_on_while_it_is_scored(made: Callable[[Targets], Task]) -> None:
    wanted = np.repeat([[0.0], [1.0]], BLOCK * PARTS, axis=1)
    found = cross_validate(made(Targets(wanted)), TuningOptions())
    assert found.each_rad == pytest.approx((1.0, 1.0), abs=1e-6)


@pytest.mark.parametrize("made", [lambda task: task, kept], ids=["searched", "visited"])
def test_a_part_is_not_tuned_on_while_it_is_scored(made: Callable[[Targets], Task]) -> None:
    part = BLOCK * PARTS // SINGLE_FOLDS
    wanted = np.concatenate((np.zeros(4 * part), np.ones(part)))[np.newaxis]
    found = cross_validate(made(Targets(wanted)), TuningOptions())
    assert found.each_rad[-1] == pytest.approx(1.0, abs=1e-6)
    assert found.each_rad[0] == pytest.approx(0.25, abs=1e-6)


def test_of_points_that_do_nearly_as_well_the_usual_one_is_taken() -> None:
    task = kept(Targets(np.full((2, BLOCK * PARTS), 10.0), lambda points: 1.0 + points[:, 0]))
    assert retune(task, np.ones((1, 2, 1)), TuningOptions())[0, 0] == 0.0
