"""Finding a design: from recordings to a tuned filter and what is known of it."""

import platform
import tempfile
from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hostkit import __version__
from hostkit.errors import RecordingError
from hostkit.optimisers import SwarmResult
from hostkit.recordings import LargeRecording, Recording
from hostkit.records import FilterDesign, RecordingDigest, TuningRecord
from hostkit.tuning.archive import archived
from hostkit.tuning.calibration import with_calibration
from hostkit.tuning.determination import Interval, Profile, intervals, profiles, remarks
from hostkit.tuning.evaluation import Evaluation, evaluate, mean_rms_rad, require_rate
from hostkit.tuning.options import TuningOptions
from hostkit.tuning.retuning import LEAST_UNITS, HeldOut, bootstrap, cross_validate
from hostkit.tuning.search import choose_optimiser, search
from hostkit.tuning.sensor_choice import sensor_config
from hostkit.tuning.start import default_point, search_from
from hostkit.tuning.task import Task
from hostkit.tuning.tuner import AnyRecording
from hostkit.tuning.tuners import TUNERS
from hostkit.units import DEG_PER_RAD

Vector = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class TuningResult:
    """A design, how the search went, and how the design does.

    Attributes
    ----------
    evaluations
        The design on its own recordings.
    rms_rad
        Mean over them of the RMSE of the axis, or of the inclination: a training figure.
    held_out
        The same figure on what was left out; None if that was not asked for.
    intervals, profiles
        The tuned parameters, and the cost along each of them.
    remarks
        What the recordings do not determine, one sentence each.
    """

    design: FilterDesign
    swarm: SwarmResult
    evaluations: tuple[Evaluation, ...]
    rms_rad: float
    held_out: HeldOut | None
    intervals: tuple[Interval, ...]
    profiles: tuple[Profile, ...]
    remarks: tuple[str, ...]


def tune(recordings: tuple[AnyRecording, ...], options: TuningOptions) -> TuningResult:
    """Tune a filter on recordings that have a reference.

    Raises
    ------
    RecordingError
        If a recording has no reference or no valid sample, or the rates differ.
    HostkitError
        If an option is not possible, or the cost is finite nowhere.
    """
    with tempfile.TemporaryDirectory(prefix="hostkit-") as folder:
        problem = tuning_task(recordings, options, Path(folder))
        if problem.is_dear:
            problem = archived(problem, LEAST_UNITS)
        return _tune(problem, recordings, options)


def _tune(
    problem: Task, recordings: tuple[AnyRecording, ...], options: TuningOptions
) -> TuningResult:
    rate_hz = recordings[0].rate_hz
    optimiser = choose_optimiser(options.optimiser, len(problem.space.dimensions))
    swarm = _search(problem, options, optimiser)
    design = FilterDesign(
        filter=options.filter,
        axes=options.axes,
        tilt=options.tilt,
        mounting=options.mounting,
        rate_hz=rate_hz,
        sensor=options.sensor or sensor_config(recordings, rate_hz),
        parameters=problem.space.design_parameters(swarm.x),
        calibration=options.calibration,
    )
    evaluations = tuple(evaluate(design, _in_memory(recording)) for recording in recordings)
    rms = _training_rms_rad(design, problem, swarm.x, recordings, evaluations)
    held_out = cross_validate(problem, options) if options.held_out else None
    again = bootstrap(problem, options)
    walked = profiles(problem, swarm.x)
    record = _record(recordings, options, optimiser, swarm, rms, held_out)
    return TuningResult(
        design=replace(design, tuning=record),
        swarm=swarm,
        evaluations=evaluations,
        rms_rad=rms,
        held_out=held_out,
        intervals=intervals(problem.space.dimensions, swarm.x, again),
        profiles=walked,
        remarks=(
            *remarks(problem, swarm.x, swarm.cost, walked),
            *_beside_default(problem, options, held_out),
        ),
    )


def _search(problem: Task, options: TuningOptions, optimiser: str) -> SwarmResult:
    """Search; where points are dear the search is short, and the default is one of them."""
    if not problem.is_dear:
        return search(problem, options, optimiser)
    start = default_point(problem.space, TUNERS[options.filter])
    return search_from(problem, options, optimiser, start)


def _beside_default(
    problem: Task, options: TuningOptions, held_out: HeldOut | None
) -> tuple[str, ...]:
    """Say where the default, which was tuned on none of the recordings, does as well."""
    if held_out is None or not problem.is_dear:
        return ()
    start = default_point(problem.space, TUNERS[options.filter])
    rms = float(np.mean([problem.rms_rad(start, i) for i in range(len(problem.lengths))]))
    if not rms <= held_out.rms_rad:
        return ()
    return (
        f"the defaults, {rms * DEG_PER_RAD:.4f} deg, do as well as a tuned design on recordings "
        "that were left out: these recordings do not call for tuning",
    )


def tuning_task(recordings: tuple[AnyRecording, ...], options: TuningOptions, folder: Path) -> Task:
    """Lay recordings out for the search.

    Parameters
    ----------
    folder
        Where recordings that do not fit the memory are laid out.

    Raises
    ------
    RecordingError
        If a recording has no reference or no valid sample, or the rates differ.
    DesignError
        If the free and fixed parameters do not go together.
    """
    rate_hz = _common_rate(recordings)
    return TUNERS[options.filter].task(recordings, with_calibration(options, rate_hz), folder)


def _in_memory(recording: AnyRecording) -> Recording:
    """Return what both models are run on: the recording, or the first part of a large one."""
    return recording.head if isinstance(recording, LargeRecording) else recording


def _training_rms_rad(
    design: FilterDesign,
    problem: Task,
    x: Vector,
    recordings: tuple[AnyRecording, ...],
    evaluations: tuple[Evaluation, ...],
) -> float:
    """Return the figure of the integer model, or of the error form where that is too long."""
    each = []
    for i, (recording, evaluation) in enumerate(zip(recordings, evaluations, strict=True)):
        if isinstance(recording, LargeRecording):
            each.append(problem.rms_rad(x, i))
        else:
            own = headline_rms_rad(design, (evaluation,))
            assert own is not None
            each.append(own)
    return float(np.mean(each))


def headline_rms_rad(design: FilterDesign, evaluations: tuple[Evaluation, ...]) -> float | None:
    """Return the one figure of a design: its axis, or the inclination where it has both."""
    quantity = "inclination" if design.axes == "both" else design.axes
    return mean_rms_rad(evaluations, quantity)


def versions() -> tuple[tuple[str, str], ...]:
    """Return the versions that decide the digits of a tuning."""
    return (
        ("hostkit", __version__),
        ("numpy", version("numpy")),
        ("python", platform.python_version()),
        ("scipy", version("scipy")),
    )


def _record(
    recordings: tuple[AnyRecording, ...],
    options: TuningOptions,
    optimiser: str,
    swarm: SwarmResult,
    rms_rad: float,
    held_out: HeldOut | None,
) -> TuningRecord:
    return TuningRecord(
        objective=options.objective,
        optimiser=optimiser,
        seed=options.seed,
        particles=options.particles,
        iterations=options.iterations,
        evaluations=swarm.evaluations,
        rmse_deg=round(rms_rad * DEG_PER_RAD, 9),
        held_out_rmse_deg=(None if held_out is None else round(held_out.rms_rad * DEG_PER_RAD, 6)),
        recordings=tuple(
            RecordingDigest(name=r.name, sha256=r.sha256, samples=len(r)) for r in recordings
        ),
        versions=versions(),
    )


def _common_rate(recordings: tuple[AnyRecording, ...]) -> float:
    if not recordings:
        raise RecordingError("there is no recording to tune on; name at least one")
    rate_hz = recordings[0].rate_hz
    for recording in recordings:
        require_rate(rate_hz, recording)
    return rate_hz
