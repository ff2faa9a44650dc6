"""Designs that tests share."""

import math

from hostkit.filters.complementary import parameter, parameters
from hostkit.mounting import Mounting
from hostkit.records import AXES, AxisChoice, FilterDesign, Parameter, SensorConfig, TiltMethod


def design(
    *,
    axes: AxisChoice = "both",
    tilt: TiltMethod = "atan2",
    mounting: str = "+x+y+z",
    rate_hz: float = 100.0,
    eta: float = 0.9965,
    gyro_full_scale_deg_s: int = 500,
    accel_full_scale_g: int = 2,
    low_pass_setting: int = 3,
    more: tuple[Parameter, ...] = (),
) -> FilterDesign:
    return FilterDesign(
        filter="complementary",
        axes=axes,
        tilt=tilt,
        mounting=Mounting.parse(mounting),
        rate_hz=rate_hz,
        sensor=SensorConfig(
            part="mpu6050",
            gyro_full_scale_deg_s=gyro_full_scale_deg_s,
            accel_full_scale_g=accel_full_scale_g,
            low_pass_setting=low_pass_setting,
        ),
        parameters=parameters(eta, *more),
    )


def more_parameters(
    axes: AxisChoice = "both",
    *,
    bias_deg_s: tuple[float, float] | None = None,
    scale: tuple[float, float] | None = None,
    offset_deg: tuple[float, float] | None = None,
    gate_g: float | None = None,
    integral_gain: float | None = None,
) -> tuple[Parameter, ...]:
    """Parameters beside eta; the pairs are of roll and pitch."""
    found = []
    for i, axis in enumerate(("roll", "pitch")):
        if axis not in AXES[axes]:
            continue
        if bias_deg_s is not None:
            found.append(parameter("gyro_bias", math.radians(bias_deg_s[i]), axis))
        if scale is not None:
            found.append(parameter("gyro_scale", scale[i], axis))
        if offset_deg is not None:
            found.append(parameter("tilt_offset", math.radians(offset_deg[i]), axis))
    if gate_g is not None:
        found.append(parameter("gate", gate_g))
    if integral_gain is not None:
        found.append(parameter("integral_gain", integral_gain))
    return tuple(sorted(found, key=lambda p: p.name))


def all_parameters(axes: AxisChoice = "both", **options: object) -> FilterDesign:
    """A design with every parameter that the filter has."""
    more = more_parameters(
        axes,
        bias_deg_s=(1.5, -0.75),
        scale=(0.01, -0.02),
        offset_deg=(2.0, -3.5),
        gate_g=0.1,
        integral_gain=0.2,
    )
    return design(axes=axes, more=more, **options)
