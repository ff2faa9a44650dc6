"""The ATmega328P at 16 MHz, as on an Arduino Uno or Nano.

A 16 MHz AVR makes 250, 500 and 1000 kbit/s exactly and 115.2 kbit/s 2.1 % too fast, hence 500.
At double speed its USART divides the clock by 8 and by a whole number of up to 4096. Of its 32 KiB
of flash the boot loader of an Uno takes 512 bytes.
"""

from hostkit.targets.target import Target
from hostkit.targets.uart import UartClock

ATMEGA328P = Target(
    name="atmega328p",
    title="ATmega328P at 16 MHz (Arduino Uno, Nano)",
    kind="mcu",
    folders=("common", "virtual_mpu6050", "atmega328p"),
    clock_hz=16_000_000,
    baud=500_000,
    flash_bytes=32 << 10,
    loader_bytes=512,
    uart=UartClock(tick_hz=16e6 / 8, least=1, most=4096, tolerance=0.025),
    arduino=True,
)
