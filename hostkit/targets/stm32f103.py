"""The STM32F103C8 at 72 MHz, as on a Blue Pill: 64 KiB of flash, 20 KiB of RAM.

USART 1 divides 72 MHz by a whole number from 16 on; by 144 for 500 kbit/s, exactly.
"""

from hostkit.targets.target import Target
from hostkit.targets.uart import UartClock

STM32F103 = Target(
    name="stm32f103",
    title="STM32F103C8 at 72 MHz (Blue Pill)",
    kind="mcu",
    folders=("common", "virtual_mpu6050", "stm32f103"),
    clock_hz=72_000_000,
    baud=500_000,
    flash_bytes=62 << 10,
    uart=UartClock(tick_hz=72e6, least=16, most=65535, tolerance=0.025),
)
