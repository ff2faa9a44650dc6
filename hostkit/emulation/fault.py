"""Faults of the virtual sensor that a run is to meet: their names, amounts and times."""

import re
from dataclasses import dataclass

from hostkit.emulation.board import PlannedFault, SensorFaults
from hostkit.errors import EmulationError

LIMIT = 16
"""So many faults the virtual sensor can plan for one run."""
AMOUNT_MAX = 2**32 - 1
PATTERN = re.compile(r"(?P<name>[a-z-]+)(=(?P<amount>\w+))?(@(?P<time>[0-9.]+))?")


@dataclass(frozen=True, slots=True, kw_only=True)
class FaultKind:
    """What can go wrong.

    Attributes
    ----------
    name
        For the command line.
    code
        Its place in ``hk_fault_kind_t`` of the virtual sensor.
    amount
        How much of it, unless something else is wanted.
    meaning
        What happens, and what the amount counts.
    """

    name: str
    code: int
    amount: int
    meaning: str


KINDS = tuple(
    FaultKind(name=name, code=code, amount=amount, meaning=meaning)
    for code, (name, amount, meaning) in enumerate(
        (
            ("nack-address", 3, "addressings that are not acknowledged"),
            ("nack-data", 2, "written bytes that are not acknowledged"),
            ("torn-burst", 6, "bytes after which a burst breaks off"),
            ("stuck-sda", 9, "clocks until the held data line is free"),
            ("clock-stretch", 3000, "microseconds for which the clock is held"),
            ("wrong-identity", 0x12, "the answer to WHO_AM_I"),
            ("register-upset", 0x1B10, "register times 256 plus the bits that turn over"),
            ("self-reset", 0, "the supply dips and the sensor resets"),
            ("frozen-data", 0, "the data stay as they are until a reset"),
            ("lost-data-ready", 100, "samples that the INT pin does not announce"),
            ("fifo-overflow", 80, "times that a sample enters the FIFO once more"),
            ("torn-count", 0x6A, "the high byte that the FIFO count reads once"),
            ("misaligned", 1, "bytes that are lost from the FIFO"),
            ("brown-out-write", 5, "register writes before the one in which the supply dips"),
            ("stuck-value", 0x3205, "samples times 256 plus the axis that stays as it is"),
            ("saturated-axis", 0x3205, "samples times 256 plus the axis at the end of its range"),
            ("weak-response", 50, "percent of the factory trim that the self-test answers with"),
            ("no-trim", 0, "the factory codes of the self-test read 0"),
        )
    )
)
"""Every kind, in the order of the virtual sensor's codes.

Axes 0 to 2 are the accelerometer's, 3 to 5 the gyroscope's; 0 samples last until a reset.
"""


STANDBY_REGISTER = 0x6C
SPOILING = ("stuck-value", "saturated-axis")


@dataclass(frozen=True, slots=True, kw_only=True)
class Fault:
    """One fault and when it strikes: at a time of the recording, s."""

    kind: FaultKind
    amount: int
    time_s: float

    def __str__(self) -> str:
        return f"{self.kind.name}={self.amount}@{self.time_s:g}"

    @property
    def spoils_an_axis(self) -> bool:
        """Whether one axis of samples is wrong, and nothing tells them from true ones."""
        standby = self.kind.name == "register-upset" and self.amount >> 8 == STANDBY_REGISTER
        return standby or self.kind.name in SPOILING

    def row(self, rate_hz: float) -> int:
        """Return the row of the recording at whose sampling it strikes."""
        return round(self.time_s * rate_hz)


def parse_fault(text: str) -> Fault:
    """Read ``NAME[=AMOUNT][@TIME]``; the amount may be hexadecimal, the time is in seconds.

    Raises
    ------
    EmulationError
        If there is no such fault, or if amount or time are no numbers in their range.
    """
    match = PATTERN.fullmatch(text)
    found = [kind for kind in KINDS if match and kind.name == match["name"]]
    if match is None or not found:
        names = ", ".join(kind.name for kind in KINDS)
        raise EmulationError(f"{text!r} is no fault; it is NAME[=AMOUNT][@TIME] with: {names}")
    try:
        amount = found[0].amount if match["amount"] is None else int(match["amount"], 0)
        time_s = float(match["time"] or 0.0)
    except ValueError as error:
        raise EmulationError(f"fault {text!r}: amount or time is no number: {error}") from error
    if not 0 <= amount <= AMOUNT_MAX:
        raise EmulationError(f"fault {text!r}: the amount must be from 0 to {AMOUNT_MAX}")
    return Fault(kind=found[0], amount=amount, time_s=time_s)


def planned_faults(faults: tuple[Fault, ...], rows: int, rate_hz: float) -> SensorFaults:
    """Return faults as the virtual sensor plans them for a recording of so many rows.

    Raises
    ------
    EmulationError
        If they are too many, or if one comes after the end of the recording.
    """
    if len(faults) > LIMIT:
        raise EmulationError(f"{len(faults)} faults are asked for; a run has {LIMIT} at most")
    for fault in faults:
        if fault.row(rate_hz) >= rows:
            end_s = (rows - 1) / rate_hz
            raise EmulationError(f"fault {fault} comes after the end of the recording, {end_s:g} s")
    return SensorFaults(
        planned=tuple(
            PlannedFault(code=fault.kind.code, row=fault.row(rate_hz), amount=fault.amount)
            for fault in faults
        )
    )
