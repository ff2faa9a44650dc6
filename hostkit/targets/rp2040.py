"""The RP2040 at 125 MHz, as on a Raspberry Pi Pico.

Its UART divides 125 MHz to 500 kbit/s exactly: 15 40/64 times 16. The divisor has 16 bits
and 6 more of a fraction, so 4 times the clock is divided by a whole number.
"""

from hostkit.targets.target import Target
from hostkit.targets.uart import UartClock

RP2040 = Target(
    name="rp2040",
    title="RP2040 at 125 MHz (Raspberry Pi Pico)",
    kind="mcu",
    folders=("common", "virtual_mpu6050", "rp2040"),
    clock_hz=125_000_000,
    baud=500_000,
    flash_bytes=2040 << 10,
    uart=UartClock(tick_hz=4 * 125e6, least=64, most=65535 * 64, tolerance=0.01),
)
