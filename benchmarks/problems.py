"""What is tuned here: simulated recordings, laid out for the kernel."""

import functools
from dataclasses import replace

import numpy as np
from numpy.typing import DTypeLike, NDArray

from hostkit.mounting import Mounting
from hostkit.recordings import Recording
from hostkit.records import Objective, SensorConfig
from hostkit.simulation import SensorErrors, simulate
from hostkit.tuning import FreeName
from hostkit.tuning.complementary.objective import Layout, prepare
from hostkit.tuning.complementary.problem import Problem
from hostkit.tuning.complementary.space import search_space
from hostkit.tuning.kernel import ErrorStream, Kernel, kernel
from hostkit.tuning.kernel.arrays import COLUMNS

SENSOR = SensorConfig(
    part="mpu6050", gyro_full_scale_deg_s=500, accel_full_scale_g=4, low_pass_setting=3
)
TAU: tuple[FreeName, ...] = ("tau",)
SIX: tuple[FreeName, ...] = (
    "tau",
    "gyro_bias",
    "gyro_scale",
    "tilt_offset",
    "gate",
    "integral_gain",
)
SHAKEN = SensorErrors(vibration_m_s2=2.0)


@functools.lru_cache(maxsize=8)
def steps(samples: int, rate_hz: float, seed: int = 1) -> Recording:
    """Return a recording of quick turns between held angles, shaken."""
    return simulate(
        "steps",
        duration_s=samples / rate_hz,
        rate_hz=rate_hz,
        sensor=SENSOR,
        errors=SHAKEN,
        rng=np.random.default_rng(seed),
    )


def problem(
    recording: Recording,
    *,
    objective: Objective = "rmse",
    free: tuple[FreeName, ...] = TAU,
    stream: DTypeLike = np.float64,
    arithmetic: DTypeLike = np.float64,
    by: Kernel | None = None,
) -> Problem:
    """Return a recording as a problem of its roll axis.

    Parameters
    ----------
    stream, arithmetic
        Types of the stream and of the arithmetic on it.
    by
        Kernel; by default the best one that there is.
    """
    space = search_space("roll", 1.0 / recording.rate_hz, free)
    layout = Layout(
        axes="roll",
        tilt="atan2",
        mounting=Mounting(),
        period_s=space.period_s,
        full=not space.plain,
        dtype=stream,
    )
    return Problem(
        space=space,
        streams=(prepare(recording, layout),),
        objective=objective,
        dtype=arithmetic,
        kernel=by or kernel(),
    )


def stream_of(one: Problem) -> ErrorStream:
    """Return the only stream of a problem."""
    ((stream,),) = one.streams
    assert isinstance(stream, ErrorStream)
    return stream


def repeated(stream: ErrorStream, samples: int) -> ErrorStream:
    """Return a stream of so many samples, all scored: for speed, the values do not matter."""

    def resized(column: NDArray[np.floating] | None) -> NDArray[np.floating] | None:
        return None if column is None else np.resize(column, samples)

    found = {name: resized(c) for name, c in zip(COLUMNS, stream.columns, strict=True)}
    return replace(stream, runs=np.array([[0, samples]]), **found)  # type: ignore[arg-type]
