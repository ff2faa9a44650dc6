"""Proofs of single blocks: which, how small, and the bounds that are the smallest that hold."""

from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """A block, its generics, the parameters of its harness, and how it is decided."""

    entity: str
    generics: dict[str, int] = field(default_factory=dict)
    bounds: dict[str, int] = field(default_factory=dict)
    by_induction: bool = False


PHASE, HIGH, MARK, PATIENCE = 7, 3, 8, 9
"""Clocks of the bus master at 8 MHz, and bits of the count of its phases with SCL low."""
COMMAND_CLOCKS = 2**PATIENCE * PHASE + 9 * (3 * PHASE + HIGH + MARK) + 1

CASES = {
    "transmitter": Case(
        entity="hk_uart_tx", generics={"CLOCK_HZ": 8, "BAUD": 2}, bounds={"BUSY": 40}
    ),
    "bus master": Case(
        entity="hk_i2c_master",
        generics={"CLOCK_HZ": 8_000_000},
        bounds={
            "PHASE": PHASE,
            "HIGH": HIGH,
            "MARK": MARK,
            "PATIENCE": PATIENCE,
            "BOUND": COMMAND_CLOCKS,
        },
        by_induction=True,
    ),
    "axi4lite": Case(entity="hk_axi4lite", bounds={"READ": 5, "WRITE": 6}),
    "wishbone": Case(entity="hk_wishbone", bounds={"BOUND": 3}),
    "queue": Case(
        entity="hk_result_queue", generics={"BITS": 2, "ADDRESS_BITS": 3}, bounds={"MOST": 6}
    ),
}
