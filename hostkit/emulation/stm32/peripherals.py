"""The blocks of the STM32F103 as they are after a reset, and where their registers stand."""

from collections.abc import Callable
from dataclasses import dataclass

from hostkit.emulation.stm32.clocks import (
    APB1ENR,
    APB2ENR,
    BY_POWER,
    BY_REQUEST,
    BY_WATCHDOG,
    Clocks,
)
from hostkit.emulation.stm32.core import Core
from hostkit.emulation.stm32.flash import Flash, Store
from hostkit.emulation.stm32.i2c import I2cMaster
from hostkit.emulation.stm32.nvic import ControlBlock, Nvic, Requester
from hostkit.emulation.stm32.pins import Lines, Port, Selector, Wires
from hostkit.emulation.stm32.timeline import Device, Peripheral
from hostkit.emulation.stm32.timer import Timer
from hostkit.emulation.stm32.usart import Usart
from hostkit.emulation.stm32.watchdog import Watchdog
from hostkit.emulation.virtual_sensor import VirtualSensor
from hostkit.errors import EmulationError

BLOCK_SHIFT = 10
OFFSET = (1 << BLOCK_SHIFT) - 1
TX_PIN, RX_PIN = 9, 10
EXTI9_5, TIM2, TIM3, USART1 = 23, 28, 29, 37


@dataclass(frozen=True, slots=True, kw_only=True)
class Outside:
    """What is around the part and outlasts its resets.

    Attributes
    ----------
    sensor, store
        The sensor on port B, and the content of the last two pages of the flash.
    peer_baud, heard
        Rate of who is at the link, bit/s; called with every byte that it hears.
    crystal_starts, lsi_hz
        Whether the crystal oscillates; rate of the watchdog's oscillator.
    reset
        Called with the flag of RCC_CSR when something resets the part.
    """

    sensor: VirtualSensor
    store: Store
    peer_baud: int
    heard: Callable[[int], None]
    crystal_starts: bool
    lsi_hz: int
    reset: Callable[[int], None]


class Peripherals:
    """All blocks.

    Parameters
    ----------
    flags
        What RCC_CSR says of the resets so far.

    Attributes
    ----------
    devices
        Those that change by themselves.
    """

    def __init__(self, core: Core, outside: Outside, flags: int) -> None:
        time, sensor, reset = core.state.time, outside.sensor, outside.reset
        self.clocks = Clocks(time, crystal_starts=outside.crystal_starts, reset_flags=flags)
        self.timer, self.ticker = Timer(time, self.clocks), Timer(time, self.clocks)
        self.port_a, self.port_b, self.lines = Port(), Port(), Lines()
        self.wires = Wires(time, self.port_b, self.lines, sensor)
        self.i2c = I2cMaster(time, self.clocks, self.wires, sensor)
        self.usart = Usart(time, self.clocks, peer_baud=outside.peer_baud, heard=outside.heard)
        self.flash = Flash(time, self.clocks, outside.store, lambda: reset(BY_POWER))
        self.watchdog = Watchdog(time, outside.lsi_hz, lambda: reset(BY_WATCHDOG))
        self.devices: tuple[Device, ...] = (
            *(self.clocks, self.timer, self.ticker, self.wires),
            *(self.i2c, self.usart, self.flash, self.watchdog),
        )
        lines: dict[int, Requester] = {EXTI9_5: self.lines, USART1: self.usart}
        lines |= {TIM2: self.timer, TIM3: self.ticker}
        self.nvic = Nvic(core, lines)
        self._wire(ControlBlock(core, lambda: reset(BY_REQUEST)))

    def _wire(self, control: ControlBlock) -> None:
        placed: tuple[tuple[int, Peripheral, tuple[int, int] | None], ...] = (
            (0x40000000, self.timer, (APB1ENR, 0)),
            (0x40000400, self.ticker, (APB1ENR, 1)),
            (0x40003000, self.watchdog, None),
            (0x40005400, self.i2c, (APB1ENR, 21)),
            (0x40010000, Selector(self.lines), (APB2ENR, 0)),
            (0x40010400, self.lines, None),
            (0x40010800, self.port_a, (APB2ENR, 2)),
            (0x40010C00, self.port_b, (APB2ENR, 3)),
            (0x40013800, self.usart, (APB2ENR, 14)),
            (0x40021000, self.clocks, None),
            (0x40022000, self.flash, None),
            (0xE000E000, self.nvic, None),
            (0xE000EC00, control, None),
        )
        self._places = {
            start >> BLOCK_SHIFT: (peripheral, gate) for start, peripheral, gate in placed
        }

    def find(self, address: int) -> Peripheral | None:
        """Return what answers at an address; None for a block that has no clock.

        Raises
        ------
        EmulationError
            If nothing there is modelled.
        """
        found = self._places.get(address >> BLOCK_SHIFT)
        if found is None:
            raise EmulationError(f"the firmware uses {address:#010x}, which is not modelled")
        peripheral, gate = found
        return peripheral if gate is None or self.clocks.clocked(*gate) else None

    def connect_link(self) -> None:
        """Look at how the pins of the link are configured."""
        self.usart.wired = self.port_a.peripheral(TX_PIN)
        self.usart.listens = not self.port_a.mode(RX_PIN) & 3
