"""Faults of the sensor as generics of the bench of a whole FPGA system."""

from collections.abc import Callable

from hostkit.emulation.fault import Fault
from hostkit.emulation.system_bench import SystemTiming
from hostkit.errors import EmulationError
from hostkit.records import FilterDesign
from hostkit.sensors.mpu6050 import settle_samples

US_PER_S = 1e6
SET_UP_US = 245_000.0
"""About the time the driver takes before samples come; the sensor's waits are most of it."""
SET_UP_ADDRESSINGS = 47
ADDRESSINGS = 4
"""Times the sensor is addressed, about: before samples come, and for each of them."""

Generics = tuple[tuple[str, str], ...]


def fault_generics(
    faults: tuple[Fault, ...], design: FilterDesign, timing: SystemTiming
) -> Generics:
    """Return the generics of the bench that let faults strike.

    The model of the sensor knows the time since its supply came, or how often it was addressed, so a
    fault may come some samples beside its row.

    Raises
    ------
    EmulationError
        If the model has no such fault, or one is asked for twice.
    """
    found: dict[str, str] = {}
    for fault in faults:
        make = KINDS.get(fault.kind.name)
        if make is None:
            raise EmulationError(
                f"the simulated sensor of an FPGA has no fault {fault.kind.name}; "
                f"it has: {', '.join(KINDS)}"
            )
        pairs = make(fault, design, timing)
        if found.keys() & pairs.keys():
            raise EmulationError(f"the fault {fault.kind.name} can strike once in a run")
        found |= {name: str(value) for name, value in pairs.items()}
    return tuple(found.items())


def _at_us(fault: Fault, design: FilterDesign, timing: SystemTiming) -> int:
    settling_us = US_PER_S * design.period_s * settle_samples(design.sensor, design.rate_hz)
    begin_us = SET_UP_US + settling_us
    return round((begin_us + US_PER_S * fault.time_s) / timing.time_divisor)


def _at_addressing(fault: Fault, design: FilterDesign) -> int:
    samples = settle_samples(design.sensor, design.rate_hz) + fault.row(design.rate_hz)
    return SET_UP_ADDRESSINGS + ADDRESSINGS * samples


Make = Callable[[Fault, FilterDesign, SystemTiming], dict[str, int]]

KINDS: dict[str, Make] = {
    "nack-address": lambda fault, design, _: {
        "NACK_AT": _at_addressing(fault, design),
        "NACKS": max(1, fault.amount),
    },
    "torn-burst": lambda fault, design, timing: {"TORN_AT_US": _at_us(fault, design, timing)},
    "stuck-sda": lambda fault, design, timing: {
        "STUCK_AT_US": _at_us(fault, design, timing),
        "STUCK_CLOCKS": max(1, fault.amount),
    },
    "clock-stretch": lambda fault, design, _: {
        "STRETCH_AT": _at_addressing(fault, design),
        "STRETCH_US": fault.amount,
    },
    "wrong-identity": lambda fault, design, timing: {"IDENTITY": fault.amount & 0xFF},
    "register-upset": lambda fault, design, timing: {
        "UPSET_AT_US": _at_us(fault, design, timing),
        "UPSET_REGISTER": fault.amount >> 8,
        "UPSET_BITS": fault.amount & 0xFF,
    },
    "self-reset": lambda fault, design, timing: {"RESET_AT_US": _at_us(fault, design, timing)},
    "frozen-data": lambda fault, design, timing: {"FROZEN_AT_US": _at_us(fault, design, timing)},
    "lost-data-ready": lambda fault, design, timing: {
        "MUTE_AT_US": _at_us(fault, design, timing),
        "MUTE_SAMPLES": fault.amount,
    },
}
"""The faults that the model has."""
