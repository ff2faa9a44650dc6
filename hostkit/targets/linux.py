"""A single-board computer with Linux: the sensor on i2c-dev, its INT on a gpio line.

The terminals of Linux have names for the usual rates only.
"""

from hostkit.targets.target import Target
from hostkit.targets.uart import FixedRates

LINUX = Target(
    name="linux",
    title="single-board computer with Linux (i2c-dev)",
    kind="mcu",
    folders=("common", "virtual_mpu6050", "linux"),
    baud=500_000,
    uart=FixedRates(
        rates=(
            *(9600, 19200, 38400, 57600, 115200, 230400),
            *(460800, 500000, 921600, 1000000, 2000000),
        )
    ),
)
