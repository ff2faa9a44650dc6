"""The RP2040 at 125 MHz, as on a Raspberry Pi Pico.

Its UART divides 125 MHz to 500 kbit/s exactly: 15 40/64 times 16.
"""

from hostkit.targets.target import Target

RP2040 = Target(
    name="rp2040",
    title="RP2040 at 125 MHz (Raspberry Pi Pico)",
    kind="mcu",
    folders=("common", "virtual_mpu6050", "rp2040"),
    clock_hz=125_000_000,
    baud=500_000,
)
