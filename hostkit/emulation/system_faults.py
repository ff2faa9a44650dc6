"""Faults of the sensor as generics of the bench of a whole FPGA system."""

from collections.abc import Callable

from hostkit.emulation.fault import Fault
from hostkit.emulation.system_bench import SystemTiming
from hostkit.errors import EmulationError
from hostkit.records import FilterDesign
from hostkit.sensors.mpu6050 import settle_samples

US_PER_S = 1e6
BEFORE_US = 30
"""So long before its sample a fault strikes, between two transfers."""
SET_UP_ADDRESSINGS = 40
ADDRESSINGS = 4.4
"""Times the sensor is addressed, about: before samples come, and for each of them."""

Generics = tuple[tuple[str, str], ...]


def fault_generics(
    faults: tuple[Fault, ...], design: FilterDesign, timing: SystemTiming, first_us: int
) -> Generics:
    """Return the generics of the bench that let faults strike.

    What the sensor does not acknowledge, or answers late, is counted in addressings, so these may
    come some samples beside their row.

    Parameters
    ----------
    first_us
        When the first row is sampled in a run without faults.

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
        row, rate_hz = fault.row(design.rate_hz), design.rate_hz
        sampled = row + settle_samples(design.sensor, rate_hz)
        pairs = make(
            fault.amount,
            first_us + round(US_PER_S * row / rate_hz / timing.time_divisor) - BEFORE_US,
            SET_UP_ADDRESSINGS + round(ADDRESSINGS * sampled),
        )
        if found.keys() & pairs.keys():
            raise EmulationError(f"the fault {fault.kind.name} can strike once in a run")
        found |= {name: str(value) for name, value in pairs.items()}
    return tuple(found.items())


Make = Callable[[int, int, int], dict[str, int]]
"""From the amount of a fault, its time and its addressing to generics."""

KINDS: dict[str, Make] = {
    "nack-address": lambda amount, _, addressing: {"NACK_AT": addressing, "NACKS": max(1, amount)},
    "torn-burst": lambda _, at_us, __: {"TORN_AT_US": at_us},
    "stuck-sda": lambda amount, at_us, _: {"STUCK_AT_US": at_us, "STUCK_CLOCKS": max(1, amount)},
    "clock-stretch": lambda amount, _, addressing: {"STRETCH_AT": addressing, "STRETCH_US": amount},
    "wrong-identity": lambda amount, _, __: {"IDENTITY": amount & 0xFF},
    "register-upset": lambda amount, at_us, _: {
        "UPSET_AT_US": at_us,
        "UPSET_REGISTER": amount >> 8,
        "UPSET_BITS": amount & 0xFF,
    },
    "self-reset": lambda _, at_us, __: {"RESET_AT_US": at_us},
    "frozen-data": lambda _, at_us, __: {"FROZEN_AT_US": at_us},
    "lost-data-ready": lambda amount, at_us, _: {"MUTE_AT_US": at_us, "MUTE_SAMPLES": amount},
}
"""The faults that the model has."""
