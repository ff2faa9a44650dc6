"""An STM32F103 on the CPU emulator Unicorn: the peripherals that the firmware uses, and time."""
