"""Finding a design: the swarm over log tau on the error of the filter."""

import math
import platform
from dataclasses import dataclass, field, replace
from importlib.metadata import version

import numpy as np
from numpy.typing import NDArray

from hostkit import __version__
from hostkit.errors import RecordingError
from hostkit.filters.complementary import eta_from_tau, parameters
from hostkit.mounting import Mounting
from hostkit.optimisers import OPTIMISERS, SwarmResult
from hostkit.recordings import Recording
from hostkit.records import (
    AxisChoice,
    FilterDesign,
    Objective,
    RecordingDigest,
    SensorConfig,
    TiltMethod,
    TuningRecord,
)
from hostkit.sensors import SENSORS
from hostkit.sensors.part import Range, SensorPart
from hostkit.tuning.evaluation import Evaluation, evaluate, mean_rms_rad, require_rate
from hostkit.tuning.objective import cost, prepare
from hostkit.units import DEG_PER_RAD, STANDARD_GRAVITY_M_S2

Vector = NDArray[np.float64]

TAU_BOUNDS_S = (0.02, 100.0)
"""Range of the time constant that the paper searches."""

RANGE_MARGIN = 1.5
"""A full scale must exceed the largest reading by this factor: the next motion may be faster."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TuningOptions:
    """What the user decides about a tuning."""

    axes: AxisChoice = "both"
    mounting: Mounting = field(default_factory=Mounting)
    tilt: TiltMethod = "atan2"
    objective: Objective = "rmse"
    optimiser: str = "qpso"
    particles: int = 20
    iterations: int = 100
    seed: int = 1
    sensor: SensorConfig | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class TuningResult:
    """A design, how the search went, and how the design does on its own recordings."""

    design: FilterDesign
    swarm: SwarmResult
    evaluations: tuple[Evaluation, ...]
    rms_rad: float


def tune(recordings: tuple[Recording, ...], options: TuningOptions) -> TuningResult:
    """Tune the complementary filter on recordings that have a reference.

    Raises
    ------
    RecordingError
        If a recording has no reference or no valid sample, or the rates differ.
    HostkitError
        If an option is not possible.
    """
    rate_hz = _common_rate(recordings)
    streams = prepare(
        recordings,
        axes=options.axes,
        tilt=options.tilt,
        mounting=options.mounting,
        period_s=1.0 / rate_hz,
    )

    def swarm_cost(log_tau: Vector) -> Vector:
        tau_s = np.exp(log_tau[:, 0])
        return cost(streams, options.objective, tau_s / (tau_s + 1.0 / rate_hz))

    swarm = OPTIMISERS[options.optimiser].minimise(
        swarm_cost,
        np.log(TAU_BOUNDS_S[:1]),
        np.log(TAU_BOUNDS_S[1:]),
        particles=options.particles,
        iterations=options.iterations,
        rng=np.random.default_rng(options.seed),
    )
    eta = eta_from_tau(math.exp(swarm.x[0]), 1.0 / rate_hz)
    untuned = FilterDesign(
        filter="complementary",
        axes=options.axes,
        tilt=options.tilt,
        mounting=options.mounting,
        rate_hz=rate_hz,
        sensor=options.sensor or sensor_config(recordings, rate_hz),
        parameters=parameters(eta),
    )
    return _result(untuned, swarm, recordings, options)


def _result(
    design: FilterDesign,
    swarm: SwarmResult,
    recordings: tuple[Recording, ...],
    options: TuningOptions,
) -> TuningResult:
    evaluations = tuple(evaluate(design, recording) for recording in recordings)
    rms = headline_rms_rad(design, evaluations)
    assert rms is not None
    record = TuningRecord(
        objective=options.objective,
        optimiser=options.optimiser,
        seed=options.seed,
        particles=options.particles,
        iterations=options.iterations,
        evaluations=swarm.evaluations,
        rmse_deg=round(rms * DEG_PER_RAD, 9),
        recordings=tuple(
            RecordingDigest(name=r.name, sha256=r.sha256, samples=len(r)) for r in recordings
        ),
        versions=versions(),
    )
    return TuningResult(
        design=replace(design, tuning=record), swarm=swarm, evaluations=evaluations, rms_rad=rms
    )


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


def _common_rate(recordings: tuple[Recording, ...]) -> float:
    if not recordings:
        raise RecordingError("there is no recording to tune on; name at least one")
    rate_hz = recordings[0].rate_hz
    for recording in recordings:
        require_rate(rate_hz, recording)
    return rate_hz


def sensor_config(
    recordings: tuple[Recording, ...],
    rate_hz: float,
    *,
    gyro_full_scale_deg_s: int | None = None,
    accel_full_scale_g: int | None = None,
    low_pass_setting: int | None = None,
    part: str = "mpu6050",
) -> SensorConfig:
    """Return a sensor configuration that fits recordings; what is given is kept.

    The ranges are the narrowest that hold every reading one and a half times, the widest where none
    does. The low-pass filter is the widest whose bandwidth stays below half the sample rate.
    """
    sensor = SENSORS[part]
    rate_deg_s = max(float(np.abs(r.angular_rate_rad_s).max()) for r in recordings) * DEG_PER_RAD
    force_g = (
        max(float(np.abs(r.specific_force_m_s2).max()) for r in recordings) / STANDARD_GRAVITY_M_S2
    )
    return SensorConfig(
        part=part,
        gyro_full_scale_deg_s=gyro_full_scale_deg_s or _narrowest(sensor.gyro_ranges, rate_deg_s),
        accel_full_scale_g=accel_full_scale_g or _narrowest(sensor.accel_ranges, force_g),
        low_pass_setting=(
            _low_pass_setting(sensor, rate_hz) if low_pass_setting is None else low_pass_setting
        ),
    )


def _narrowest(ranges: tuple[Range, ...], largest: float) -> int:
    fitting = [r.full_scale for r in ranges if r.full_scale >= RANGE_MARGIN * largest]
    return fitting[0] if fitting else ranges[-1].full_scale


def _low_pass_setting(sensor: SensorPart, rate_hz: float) -> int:
    """Return the widest filter below half the rate among those that keep the 1 kHz clock."""
    filters = [lp for lp in sensor.low_passes if lp.gyro_rate_hz == sensor.sample_base_rate_hz]
    fitting = [lp for lp in filters if lp.gyro_bandwidth_hz <= rate_hz / 2.0]
    return (fitting or filters[-1:])[0].setting
