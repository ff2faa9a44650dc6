"""The tuning of the bounded-velocity observer."""

from pathlib import Path

from hostkit.errors import HostkitError
from hostkit.filters.observer.parameters import default_parameters
from hostkit.recordings import Recording
from hostkit.tuning.kernel.library import library
from hostkit.tuning.observer.kernel import SOURCES, CompiledObserver
from hostkit.tuning.observer.problem import ObserverProblem
from hostkit.tuning.observer.space import RANGES, observer_space, parameter_key, tunable
from hostkit.tuning.options import TuningOptions
from hostkit.tuning.track import track_of
from hostkit.tuning.tuner import AnyRecording, Tuner

FREE = ("kt", "kv", "kb", "start", "rest_rate", "rest_force", "rest_gain", "gyro_scale")
"""What helped on every public set of recordings while they were left out."""


def observer_problem(
    recordings: tuple[AnyRecording, ...], options: TuningOptions, folder: Path
) -> ObserverProblem:
    """Lay recordings of one rate out for the search.

    Raises
    ------
    RecordingError
        If a recording has no reference or no valid sample.
    HostkitError
        If a recording does not fit the memory.
    DesignError
        If the free and fixed parameters do not go together.
    """
    rate_hz = recordings[0].rate_hz
    fixed = {one.name for one in options.fixed}
    free = options.free or tuple(name for name in FREE if name not in fixed)
    compiled = library(SOURCES)
    return ObserverProblem(
        space=observer_space(rate_hz, free, options.fixed, options.ranges),
        tracks=tuple(track_of(_in_memory(recording)) for recording in recordings),
        rate_hz=rate_hz,
        mounting=options.mounting,
        quantity="inclination" if options.axes == "both" else options.axes,
        objective=options.objective,
        kernel=None if compiled is None else CompiledObserver(compiled),
        jobs=options.jobs,
    )


def _in_memory(recording: AnyRecording) -> Recording:
    if isinstance(recording, Recording):
        return recording
    raise HostkitError(
        f"{recording.name} has {len(recording)} samples and is read in parts; the observer is "
        "tuned on recordings that fit the memory: cut it, or name a part of it"
    )


OBSERVER_TUNER = Tuner(
    name="observer",
    tunables=tuple(tunable(search) for search in RANGES),
    key=parameter_key,
    free=FREE,
    default=default_parameters,
    task=observer_problem,
)
