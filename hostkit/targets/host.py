"""The host: the firmware as a POSIX program with the virtual sensor linked in."""

from hostkit.targets.target import Target

HOST = Target(
    name="host",
    title="POSIX program with a virtual MPU-6050",
    kind="mcu",
    folders=("common", "virtual_mpu6050", "host"),
    baud=500_000,
)
