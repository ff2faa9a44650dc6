"""hostkit's own filters in a comparison."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hostkit.attitude import inclination_rad, to_body, up_from_tilt, wrap_rad
from hostkit.comparison.row import Row, Settings
from hostkit.comparison.tuned import tuned
from hostkit.errors import RecordingError
from hostkit.filters import FILTERS
from hostkit.recordings import Recording
from hostkit.records import AXES, FilterDesign, Parameter
from hostkit.tuning import TUNERS, FixedParameter, TuningOptions, evaluate, sensor_config
from hostkit.tuning.evaluation import Evaluation
from hostkit.tuning.reference import reference_rad
from hostkit.tuning.start import default_point
from hostkit.tuning.tune import tuning_task
from hostkit.units import STANDARD_GRAVITY_M_S2

Vector = NDArray[np.float64]

LEAD, SCALE = "lead", "gyro_scale"
LEAD_PARAMETER = Parameter(name="lead_s", value=0.0, unit="s")


def default_row(recordings: tuple[Recording, ...], options: TuningOptions, lead_s: float) -> Row:
    """Run a filter of hostkit as it is without any tuning, in floats.

    Raises
    ------
    RecordingError
        If a recording has no reference.
    """
    tuner, lead_s = TUNERS[options.filter], _lead_of(options.filter, lead_s)
    rate_hz = recordings[0].rate_hz
    design = FilterDesign(
        filter=options.filter,
        axes=options.axes,
        tilt=options.tilt,
        mounting=options.mounting,
        rate_hz=rate_hz,
        sensor=options.sensor or sensor_config(recordings, rate_hz),
        parameters=_with_lead(tuner.default(), lead_s),
    )
    each = tuple(_float_rms_rad(design, recording) for recording in recordings)
    return _row(options.filter, "default", each, design.parameters, lead_s)


def design_row(
    recordings: tuple[Recording, ...], design: FilterDesign, lead_s: float | None
) -> Row:
    """Run the integer model of a design on the counts that its sensor would give.

    Parameters
    ----------
    lead_s
        How far the angles are told ahead instead of what the design says; None leaves it.

    Raises
    ------
    RecordingError
        If a recording has no reference, or another rate.
    """
    own = lead_of(design) if lead_s is None else _lead_of(design.filter, lead_s)
    parameters = design.parameters if lead_s is None else _with_lead(design.parameters, own)
    changed = replace(design, parameters=parameters)
    each = tuple(_integer_rms_rad(changed, recording) for recording in recordings)
    return _row(design.filter, "design", each, parameters, own)


def tuned_row(
    recordings: tuple[Recording, ...],
    options: TuningOptions,
    lead_s: float,
    folder: Path,
    *,
    with_scale: bool,
) -> Row:
    """Tune a filter of hostkit, and score it where it was tuned and where it was not.

    Parameters
    ----------
    folder
        For what does not fit the memory.
    with_scale
        Whether the scale of the gyroscope is tuned, where it is among what `tune` searches.

    Raises
    ------
    RecordingError
        If a recording has no reference, or the rates differ.
    """
    tuner, lead_s = TUNERS[options.filter], _lead_of(options.filter, lead_s)
    if lead_s:
        fixed = FixedParameter(name=LEAD, value=lead_s)
        options = replace(options, fixed=(*options.fixed, fixed))
    if not with_scale:
        free = tuple(name for name in tuner.free if name != SCALE)
        options = replace(options, free=free)
    task = tuning_task(recordings, options, folder)
    start = default_point(task.space, tuner) if task.is_dear else None
    found = tuned(task, start, options)
    parameters = task.space.design_parameters(found.x)
    return replace(
        _row(options.filter, "tuned", found.each_rad, parameters, lead_s),
        is_scaled=any(d.name == SCALE for d in task.space.dimensions),
        held_out=found.held_out,
        evaluations=found.evaluations,
    )


def lead_of(design: FilterDesign) -> float:
    """Return how far a design tells its angles ahead."""
    return next((p.value for p in design.parameters if p.name == LEAD_PARAMETER.name), 0.0)


def _lead_of(filter_name: str, lead_s: float) -> float:
    """Return the lead that a filter of hostkit can have: not every one can be told ahead."""
    return lead_s if TUNERS[filter_name].tunable(LEAD) is not None else 0.0


def _with_lead(parameters: tuple[Parameter, ...], lead_s: float) -> tuple[Parameter, ...]:
    others = [p for p in parameters if p.name != LEAD_PARAMETER.name]
    own = [replace(LEAD_PARAMETER, value=lead_s)] if lead_s else []
    return tuple(sorted((*others, *own), key=lambda p: p.name))


def _row(
    name: str,
    settings: Settings,
    each_rad: tuple[float, ...],
    parameters: tuple[Parameter, ...],
    lead_s: float,
) -> Row:
    return Row(
        name=name,
        title=FILTERS[name].title,
        origin="hostkit",
        settings=settings,
        lead_s=lead_s,
        each_rad=each_rad,
        parameters=parameters,
    )


def _float_rms_rad(design: FilterDesign, recording: Recording) -> float:
    axes = AXES[design.axes]
    state = FILTERS[design.filter].run_float(
        replace(design, rate_hz=recording.rate_hz),
        recording.angular_rate_rad_s,
        recording.specific_force_m_s2 / STANDARD_GRAVITY_M_S2,
    )
    angle = state[:, : len(axes)]
    reference = np.stack([reference_rad(recording, a, design.mounting) for a in axes], axis=-1)
    scored = recording.valid & np.isfinite(reference).all(axis=1)
    if not scored.any():
        raise RecordingError(f"{recording.name}: no valid sample has a reference")
    if len(axes) == 1:
        error = wrap_rad(angle - reference)[scored, 0]
    else:
        assert recording.up_reference is not None
        up = up_from_tilt(angle[scored, 0], angle[scored, 1])
        error = inclination_rad(up, to_body(design.mounting, recording.up_reference[scored]))
    return math.sqrt(float(np.mean(error**2)))


def _integer_rms_rad(design: FilterDesign, recording: Recording) -> float:
    found: Evaluation = evaluate(design, recording)
    score = found.score("inclination" if design.axes == "both" else design.axes)
    if score is None:
        raise RecordingError(f"{recording.name}: no valid sample has a reference")
    return score.rms_rad
