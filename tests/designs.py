"""Designs that tests share."""

from hostkit.filters.complementary import parameters
from hostkit.mounting import Mounting
from hostkit.records import AxisChoice, FilterDesign, SensorConfig, TiltMethod


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
        parameters=parameters(eta),
    )
