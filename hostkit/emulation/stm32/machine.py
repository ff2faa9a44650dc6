"""The whole board: core, memory, peripherals, the sensor on its pins, and the course of time."""

from hostkit.emulation.board import LinkInput
from hostkit.emulation.stm32.clocks import BY_PIN, BY_POWER
from hostkit.emulation.stm32.core import FLASH_BYTES, Core, Outcome, Segments
from hostkit.emulation.stm32.flash import STORE_BYTES, STORE_START, Store
from hostkit.emulation.stm32.peripherals import OFFSET, Outside, Peripherals
from hostkit.emulation.stm32.supply import power_again
from hostkit.emulation.stm32.timeline import NEVER, TICK_HZ, BusError, Device
from hostkit.emulation.stm32.usart import Sender
from hostkit.emulation.virtual_sensor import VirtualSensor
from hostkit.errors import EmulationError

PERIPHERALS_START, PERIPHERALS_BYTES = 0x40000000, 0x23000
CORE_START, CORE_BYTES = 0xE000E000, 0x1000
MARK_PIN = 8
TYPICAL_LSI_HZ = 40_000
PATIENCE_TICKS = TICK_HZ // 100
"""For so long a program that does not sleep may go on after the end of the table."""
LONGEST_WAIT_TICKS = TICK_HZ // 10_000
"""A program that polls looks at the clock so often at least."""
POWER_UP_TICKS = TICK_HZ * 25 // 10_000
"""From the supply's return to the first instruction: t_RSTTEMPO of the data sheet."""


class Machine:
    """An STM32F103C8 that runs an image with the virtual MPU-6050 on its pins.

    Parameters
    ----------
    image
        What is flashed.
    sensor
        The sensor on PB6, PB7 and PB8.
    peer_baud
        Rate of who is at PA9 and PA10.
    crystal_starts
        Whether the crystal oscillates.
    lsi_hz
        Rate of the watchdog's oscillator.
    store
        The first bytes of the store; the rest is erased.
    power_cut_after
        The supply fails within the byte after so many that are written to the store; None: never.
    received
        What the link receives and when.
    handles_faults
        Whether a fault goes to the program's handler instead of ending the run.

    Attributes
    ----------
    link
        Every byte that the link has sent and nobody has taken yet.
    segments
        Instructions between the marks, those of interrupts not counted.
    resets
        Resets since power-up.
    store
        The non-volatile store.
    """

    def __init__(
        self,
        image: bytes,
        sensor: VirtualSensor,
        *,
        peer_baud: int,
        crystal_starts: bool = True,
        lsi_hz: int = TYPICAL_LSI_HZ,
        store: bytes = b"",
        power_cut_after: int | None = None,
        received: tuple[LinkInput, ...] = (),
        handles_faults: bool = False,
    ) -> None:
        self.link = bytearray()
        self.segments = Segments()
        self.sensor = sensor
        self.store = Store(store, power_cut_after)
        self.resets = 0
        self._handles_faults = handles_faults
        self._core = Core(
            image,
            flash_bytes=FLASH_BYTES - STORE_BYTES,
            happen=self._let_happen,
            read=self._read,
            write=self._write,
        )
        self.time = self._core.state.time
        for start, size in (
            (PERIPHERALS_START, PERIPHERALS_BYTES),
            (CORE_START, CORE_BYTES),
            (STORE_START, STORE_BYTES),
        ):
            self._core.map(start, size)
        self._deepest_stack = 0
        self._reset_by: int | None = None
        self._sender = Sender(self.time, peer_baud, received)
        self._outside = Outside(
            sensor=sensor,
            store=self.store,
            peer_baud=peer_baud,
            heard=self.link.append,
            crystal_starts=crystal_starts,
            lsi_hz=lsi_hz,
            reset=self._reset,
        )
        self._start(BY_POWER | BY_PIN)

    # --- resets -----------------------------------------------------------------------------------

    def _start(self, flags: int) -> None:
        """Stand before the first instruction, with all peripherals as after a reset."""
        self._begun_at: int | None = None
        self._sleeping = False
        self.time.ticks_per_instruction = 1
        self._core.reset()
        self._own = own = Peripherals(self._core, self._outside, flags)
        self._sender.arrive = own.usart.arrive
        self._devices: tuple[Device, ...] = (*own.devices, self._sender)

    def _reset(self, by: int) -> None:
        """Reset the board as soon as the instruction that is carried out has ended."""
        self._reset_by = by
        self._core.stop()

    def _start_over(self) -> None:
        by, self._reset_by = self._reset_by or BY_PIN, None
        self.resets += 1
        self._deepest_stack = self.stack_bytes
        flags = self._own.clocks.reset_flags | by | BY_PIN
        if by == BY_POWER:
            flags = BY_POWER | BY_PIN
            self._core.paint()
            power_again(self.sensor, self.time.now_ns)
            self.time.now += POWER_UP_TICKS
        self.time.stalled_until = 0
        self._start(flags)
        self._plan()

    # --- what the user sees ----------------------------------------------------------------------

    @property
    def finished(self) -> bool:
        """Whether the table has been played and read, and every byte is out."""
        if self._own.wires.played_at == NEVER or not self._own.usart.idle:
            return False
        patience_over = self.time.now - self._own.wires.played_at > PATIENCE_TICKS
        return patience_over or (self._sleeping and self.sensor.exhausted)

    @property
    def stack_bytes(self) -> int:
        """Deepest stack so far."""
        return max(self._deepest_stack, self._core.stack_bytes)

    def receive(self, data: bytes) -> None:
        """Send bytes to the link from now on."""
        self._sender.send(data)
        self._plan()

    def sensor_moved(self) -> None:
        """Look at the sensor again after something was done to it from outside."""
        self._own.wires.happen()
        self._plan()

    def run(self, seconds: float) -> None:
        """Run for a span of simulated time, or until the machine has finished.

        Raises
        ------
        EmulationError
            If the firmware faults, sleeps for ever, or does what the model does not allow.
        """
        self.time.until = self.time.now + int(seconds * TICK_HZ)
        self._plan()
        while self.time.now < self.time.until and not self.finished:
            if self._reset_by is not None:
                self._start_over()
            elif self._sleeping:
                self._doze()
            else:
                self._run_instructions()

    # --- the course of time ----------------------------------------------------------------------

    def _next(self) -> Device:
        """Return what happens next."""
        first = self._devices[0]
        due = first.due
        for device in self._devices:
            if device.due < due:
                first, due = device, device.due
        return first

    def _plan(self) -> None:
        """Look at the requests, and at when the next thing happens."""
        self._own.nvic.update()
        self.time.wake = min(self.time.until, self._next().due)

    def _let_happen(self) -> None:
        """Let happen what is due, the earliest first; what befell a stalled core, each in time."""
        time = self.time
        now = time.now
        stalled = self._own.flash.due <= now
        device = self._next()
        while device.due <= now and self._reset_by is None:
            if stalled:
                time.now = device.due
            device.happen()
            device = self._next()
        time.now = now
        self._own.nvic.update()
        time.wake = min(time.until, device.due)

    def _doze(self) -> None:
        """Jump from event to event until an interrupt ends the sleep."""
        while not self._own.nvic.wakes:
            if self._next().due == NEVER:
                raise EmulationError("the firmware sleeps for ever")
            self.time.now = max(self.time.now, self.time.wake)
            self._let_happen()
            over = self.time.now >= self.time.until or self._reset_by is not None
            if over or self.finished:
                return
        self._sleeping = False

    def _run_instructions(self) -> None:
        try:
            outcome = self._core.run()
        except BusError as fault:
            self._fault(str(fault))
            return
        state = self._core.state
        if outcome is Outcome.SLEEPS:
            self._sleeping = True
        elif outcome is Outcome.FAULTS:
            self._fault(self._core.message(state.fault))
        elif outcome is Outcome.EXCEPTS:
            self._fault(f"exception {state.fault}")
        elif outcome is Outcome.BEGINS_AGAIN:
            raise EmulationError(f"the firmware jumped to its start after {self.time.now_s:.3f} s")
        elif outcome is Outcome.NO_CODE:
            self._fault("it has no code there")

    def _fault(self, why: str) -> None:
        if not self._handles_faults:
            raise EmulationError(f"the firmware faults at {self._core.fault_address:#010x}: {why}")
        self._core.enter_fault()

    # --- registers -------------------------------------------------------------------------------

    def _read(self, address: int, size: int) -> int:
        own = self._own
        if address < PERIPHERALS_START:
            return own.flash.read_store(address - STORE_START, size)
        peripheral = own.find(address)
        if peripheral is None:
            return 0
        if peripheral is own.i2c and own.i2c.polled_in_vain():
            self._wait()
        value = peripheral.read(address & OFFSET)
        if peripheral is own.i2c or peripheral is own.usart:
            self._plan()
        return value

    def _wait(self) -> None:
        """Let a program that polls in vain wait for the next event: the time passes, unspent."""
        now = self.time.now
        self.time.now = max(now, min(self._next().due, now + LONGEST_WAIT_TICKS))
        self._let_happen()

    def _write(self, address: int, size: int, value: int) -> None:
        own = self._own
        if address < PERIPHERALS_START:
            own.flash.program(address - STORE_START, size, value)
            self._plan()
            return
        peripheral = own.find(address)
        if peripheral is None:
            return
        peripheral.write(address & OFFSET, value)
        if peripheral is own.port_a:
            own.connect_link()
            self._mark(bool(own.port_a.output >> MARK_PIN & 1))
        elif peripheral is own.port_b:
            own.wires.moved_by_program()
        self._plan()

    def _mark(self, begins: bool) -> None:
        state = self._core.state
        own = state.instructions - state.foreign_instructions
        if begins and self._begun_at is None:
            self._begun_at = own
        elif not begins and self._begun_at is not None:
            self.segments.add(own - self._begun_at)
            self._begun_at = None
