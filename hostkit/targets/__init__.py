"""Targets: one module each, and their registry."""

from hostkit.registry import Registry
from hostkit.targets.atmega328p import ATMEGA328P
from hostkit.targets.ecp5 import ECP5
from hostkit.targets.host import HOST
from hostkit.targets.linux import LINUX
from hostkit.targets.rp2040 import RP2040
from hostkit.targets.spartan3adsp import SPARTAN3ADSP
from hostkit.targets.stm32f103 import STM32F103
from hostkit.targets.target import Target

__all__ = ["TARGETS", "Target"]

TARGETS: Registry[Target] = Registry(
    "target", (HOST, ATMEGA328P, RP2040, STM32F103, LINUX, SPARTAN3ADSP, ECP5)
)
