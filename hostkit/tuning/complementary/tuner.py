"""The tuning of the complementary filter: its parameters, and its problem on recordings."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from hostkit.filters.complementary import BY_NAME, parameters
from hostkit.recordings import LargeRecording, Recording
from hostkit.records import AXES
from hostkit.tuning.complementary.objective import Layout, prepare
from hostkit.tuning.complementary.problem import Problem
from hostkit.tuning.complementary.space import RANGES, search_space
from hostkit.tuning.complementary.spool import spool
from hostkit.tuning.dimension import FreeName
from hostkit.tuning.kernel import StreamSource
from hostkit.tuning.options import TuningOptions
from hostkit.tuning.tuner import AnyRecording, Tunable, Tuner

FREE = ("tau",)
USUAL_ETA = 0.98
"""What most published code has; the paper's default."""


def tuning_problem(
    recordings: tuple[AnyRecording, ...], options: TuningOptions, folder: Path
) -> Problem:
    """Lay recordings of one rate out for the search.

    Parameters
    ----------
    folder
        Where recordings that do not fit the memory are laid out.

    Raises
    ------
    RecordingError
        If a recording has no reference or no valid sample.
    DesignError
        If the free and fixed parameters do not go together.
    """
    period_s = 1.0 / recordings[0].rate_hz
    fixed = {one.name for one in options.fixed}
    free = options.free or tuple(name for name in FREE if name not in fixed)
    space = search_space(options.axes, period_s, free, options.fixed, options.ranges)
    layout = Layout(
        axes=options.axes,
        tilt=options.tilt,
        mounting=options.mounting,
        period_s=period_s,
        full=not space.plain,
        dtype=np.dtype(options.precision),
    )
    streams = tuple(
        _streams(recording, layout, folder / str(i)) for i, recording in enumerate(recordings)
    )
    return Problem(
        space=space,
        streams=streams,
        objective=options.objective,
        jobs=options.jobs,
        dtype=np.dtype(options.precision),
    )


def _streams(recording: AnyRecording, layout: Layout, folder: Path) -> tuple[StreamSource, ...]:
    if isinstance(recording, LargeRecording):
        folder.mkdir()
        return spool(recording, replace(layout, dtype=np.float32), folder)
    assert isinstance(recording, Recording)
    return prepare(recording, layout)


def _tunable(name: FreeName) -> Tunable:
    search = next(r for r in RANGES if r.name == name)
    if name == "tau":
        return Tunable(search=search, shown_unit="s")
    kind = BY_NAME[name]
    return Tunable(
        search=search,
        shown_unit=kind.shown_unit,
        shown_per_unit=kind.shown_per_unit,
        axes=AXES["both"] if kind.per_axis else (),
    )


def _key(name: FreeName, axis: str | None) -> str:
    if name == "tau":
        return BY_NAME["eta"].key(None)
    return BY_NAME[name].key(next((a for a in AXES["both"] if a == axis), None))


COMPLEMENTARY_TUNER = Tuner(
    name="complementary",
    tunables=tuple(_tunable(r.name) for r in RANGES),
    key=_key,
    free=FREE,
    default=lambda: parameters(USUAL_ETA),
    task=tuning_problem,
)
