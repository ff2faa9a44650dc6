"""Simulated recordings for the tests of the tuner."""

import numpy as np
from designs import design

from hostkit.mounting import Mounting
from hostkit.recordings import Recording
from hostkit.records import AxisChoice, FilterDesign, Objective, TiltMethod
from hostkit.simulation import SensorErrors, simulate
from hostkit.tuning.complementary.objective import Layout, prepare
from hostkit.tuning.complementary.problem import Problem
from hostkit.tuning.complementary.space import search_space
from hostkit.tuning.dimension import FixedParameter, FreeName
from hostkit.tuning.kernel import Kernel, kernel

SENSOR = design(accel_full_scale_g=4).sensor
EVERY: tuple[FreeName, ...] = (
    "tau",
    "gyro_bias",
    "gyro_scale",
    "tilt_offset",
    "gate",
    "integral_gain",
)


def recorded(
    profile: str = "steps",
    *,
    seed: int = 1,
    duration_s: float = 10.0,
    errors: SensorErrors | None = None,
) -> Recording:
    return simulate(
        profile,
        duration_s=duration_s,
        rate_hz=100.0,
        sensor=SENSOR,
        errors=SensorErrors(vibration_m_s2=2.0) if errors is None else errors,
        rng=np.random.default_rng(seed),
    )


def swept(design_: FilterDesign, duration_s: float = 4.0) -> Recording:
    """Return a sweep as the sensor of a design reads it, at its rate."""
    return simulate(
        "sine-sweep",
        duration_s=duration_s,
        rate_hz=design_.rate_hz,
        sensor=design_.sensor,
        errors=SensorErrors(),
        rng=np.random.default_rng(8),
    )


def problem(
    *recordings: Recording,
    axes: AxisChoice = "roll",
    tilt: TiltMethod = "atan2",
    objective: Objective = "rmse",
    free: tuple[FreeName, ...] = ("tau",),
    fixed: tuple[FixedParameter, ...] = (),
    dtype: type = np.float64,
    arithmetic: type = np.float64,
    full: bool | None = None,
    by: Kernel | None = None,
) -> Problem:
    space = search_space(axes, 0.01, free, fixed)
    layout = Layout(
        axes=axes,
        tilt=tilt,
        mounting=Mounting(),
        period_s=0.01,
        full=not space.plain if full is None else full,
        dtype=dtype,
    )
    streams = tuple(prepare(recording, layout) for recording in recordings)
    return Problem(
        space=space,
        streams=streams,
        objective=objective,
        dtype=arithmetic,
        kernel=by or kernel(),
    )
