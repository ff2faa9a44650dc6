"""Registers of the FPGA system: one description, from which every language's view is rendered."""

from hostkit.render.registers.content import register_map
from hostkit.render.registers.context import RegistersContext, registers_context
from hostkit.render.registers.records import Field, Register, RegisterMap

__all__ = [
    "Field",
    "Register",
    "RegisterMap",
    "RegistersContext",
    "register_map",
    "registers_context",
]
