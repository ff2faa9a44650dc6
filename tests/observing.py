"""Designs and counts that tests of the observer share."""

from collections.abc import Iterator

import numpy as np

from hostkit.filters.observer import default_parameters, parameter, parameters
from hostkit.mounting import Mounting
from hostkit.records import AxisChoice, FilterDesign, Parameter, SensorConfig
from hostkit.sensors import SENSORS

CORNERS = (-32768, -32767, -1, 0, 1, 32767)


def observer_design(
    *more: Parameter,
    axes: AxisChoice = "both",
    mounting: str = "+x+y+z",
    rate_hz: float = 100.0,
    gyro_full_scale_deg_s: int = 500,
    accel_full_scale_g: int = 4,
    bare: bool = False,
) -> FilterDesign:
    """A design with the default parameters; `bare` leaves only the gains, `more` replaces."""
    base = parameters() if bare else default_parameters()
    named = {p.name: p for p in (*base, *more)}
    return FilterDesign(
        filter="observer",
        axes=axes,
        tilt="atan2",
        mounting=Mounting.parse(mounting),
        rate_hz=rate_hz,
        sensor=SensorConfig(
            part="mpu6050",
            gyro_full_scale_deg_s=gyro_full_scale_deg_s,
            accel_full_scale_g=accel_full_scale_g,
            low_pass_setting=2,
        ),
        parameters=tuple(named[name] for name in sorted(named)),
    )


def full_design(**options: object) -> FilterDesign:
    """A design with every parameter that the observer has."""
    more = [
        parameter("lead", -0.005),
        parameter("clip_rate", 7.0),
        *(
            parameter("gyro_bias", 0.01 * k, axis)
            for k, axis in zip((1, -2, 3), "xyz", strict=True)
        ),
        *(
            parameter("gyro_scale", 0.01 * k, axis)
            for k, axis in zip((2, -1, 1), "xyz", strict=True)
        ),
        *(
            parameter("accel_offset", 0.1 * k, axis)
            for k, axis in zip((3, -2, 1), "xyz", strict=True)
        ),
        *(
            parameter("accel_scale", 0.01 * k, axis)
            for k, axis in zip((-3, 2, 1), "xyz", strict=True)
        ),
    ]
    return observer_design(*more, **options)


def weights(design: FilterDesign) -> tuple[float, float]:
    """Weight of a count of rate (rad/s) and of specific force (m/s^2)."""
    part = SENSORS[design.sensor.part]
    return part.rad_s_per_count(design.sensor), part.m_s2_per_count(design.sensor)


def motion(design: FilterDesign, samples: int = 2500, seed: int = 5) -> np.ndarray:
    """Counts of a sensor with a bias: at rest, tumbling and shaken, at rest; shape ``(N, 6)``.

    Force first. The rate is what turns the force that is there at rest.
    """
    rng = np.random.default_rng(seed)
    rad_s, m_s2 = weights(design)
    time_s = np.arange(samples) / design.rate_hz
    moving = (time_s > 3.0) & (time_s < time_s[-1] - 4.0)
    rate = np.stack([np.sin(0.7 * time_s), np.sin(1.1 * time_s), np.cos(0.9 * time_s)], axis=1)
    rate *= 2.0 * moving[:, None]
    up, force = np.array([0.1, -0.3, 0.95]), np.zeros((samples, 3))
    for k in range(samples):
        up = up + np.cross(up, rate[k]) / design.rate_hz
        up /= np.linalg.norm(up)
        force[k] = 9.80665 * up
    force += moving[:, None] * 3.0 * np.sin(9.0 * time_s)[:, None] + rng.normal(
        0, 0.02, force.shape
    )
    rate += np.array([0.02, -0.03, 0.01]) + rng.normal(0, 0.002, rate.shape)
    counts = np.hstack([force / m_s2, rate / rad_s])
    return np.clip(np.rint(counts), -32768, 32767).astype(np.int64)


def hostile(samples: int = 120, seed: int = 1) -> Iterator[tuple[str, np.ndarray]]:
    """Counts that no motion gives, each of shape ``(N, 6)``, by name."""
    rng = np.random.default_rng(seed)
    yield "noise", rng.integers(-32768, 32768, (samples, 6))
    yield "corners", rng.choice(CORNERS, (samples, 6))
    yield "lowest", np.full((samples, 6), -32768)
    yield "highest", np.full((samples, 6), 32767)
    yield "nothing", np.zeros((samples, 6), dtype=np.int64)
    steps = rng.choice((-32768, 32767), (samples // 20 + 1, 6))
    yield "steps", np.repeat(steps, 20, axis=0)[:samples]
    still = np.zeros((samples, 6), dtype=np.int64)
    still[:, 0] = rng.choice((-8192, 8192))
    yield "upright", still
    rest = rng.integers(-3, 4, (samples, 6)) + np.array([0, 0, -8192, 400, -300, 200])
    rest[samples // 2 :, 3:] += 900
    yield "rest", rest


def all_counts(design: FilterDesign) -> np.ndarray:
    """Everything above one after the other; the motion first, so that it starts at rest."""
    return np.concatenate([motion(design, 1000), *(counts for _, counts in hostile())])
