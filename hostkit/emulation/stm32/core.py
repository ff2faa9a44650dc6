"""The core and its memory: Unicorn behind an inner loop in C, and what they share with Python."""

import ctypes
import functools
import re
import subprocess
import tempfile
import weakref
from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from pathlib import Path

import unicorn

from hostkit.emulation.stm32.timeline import Timeline
from hostkit.emulation.tools import require
from hostkit.errors import BuildError, EmulationError

FLASH_START, FLASH_BYTES = 0x08000000, 64 * 1024
RAM_START, RAM_BYTES = 0x20000000, 20 * 1024
PAINT = 0xC5
VECTORS_BYTES = 8
ERASED = b"\xff"
SOURCE = Path(__file__).with_name("core.c")
FLAGS = ("-O2", "-std=gnu11", "-shared", "-fPIC")
LIBRARY = "libunicorn.so.2"
BUILD_TIMEOUT_S = 60.0
PRIVATE_WORDS = 32
"""At least as many 64-bit words as core.c keeps behind the fields of :class:`State`."""

Happen = Callable[[], None]
Read = Callable[[int, int], int]
Write = Callable[[int, int, int], None]
_Happen = ctypes.CFUNCTYPE(None)
_Read = ctypes.CFUNCTYPE(ctypes.c_uint32, ctypes.c_uint32, ctypes.c_uint32)
_Write = ctypes.CFUNCTYPE(None, ctypes.c_uint32, ctypes.c_uint32, ctypes.c_uint32)


class Outcome(IntEnum):
    """Why the inner loop came back."""

    REACHED = 0
    SLEEPS = 1
    FAILED = 2
    FAULTS = 3
    EXCEPTS = 4
    RESTARTS = 5
    BEGINS_AGAIN = 6
    NO_CODE = 7


class Interrupts(ctypes.Structure):
    """Interrupts, one bit each; the number of the one that runs; whether one is to be entered."""

    enabled: int
    pending: int
    requests: int
    active: int
    ready: int
    configuration: int
    _fields_ = [
        ("enabled", ctypes.c_uint64),
        ("pending", ctypes.c_uint64),
        ("requests", ctypes.c_uint64),
        ("active", ctypes.c_int64),
        ("ready", ctypes.c_uint64),
        ("configuration", ctypes.c_uint64),
    ]


class State(ctypes.Structure):
    """What Python and core.c share: ``core_t``."""

    time: Timeline
    interrupts: Interrupts
    instructions: int
    foreign_instructions: int
    failed: int
    begun: int
    fault: int
    fault_address: int
    _fields_ = [
        ("time", Timeline),
        ("interrupts", Interrupts),
        ("instructions", ctypes.c_uint64),
        ("foreign_instructions", ctypes.c_uint64),
        ("failed", ctypes.c_uint64),
        ("begun", ctypes.c_uint64),
        ("fault", ctypes.c_uint64),
        ("fault_address", ctypes.c_uint64),
        ("image_bytes", ctypes.c_uint64),
        ("image", ctypes.c_char_p),
        ("happen", _Happen),
        ("read", _Read),
        ("write", _Write),
        ("private", ctypes.c_uint64 * PRIVATE_WORDS),
    ]


@functools.cache
def _library() -> ctypes.CDLL:
    """Compile the inner loop once for this process, against the library of the package unicorn."""
    require("gcc")
    package = Path(unicorn.__file__).parent
    libraries = package / "lib"
    with tempfile.TemporaryDirectory(prefix="hostkit-stm32-") as folder:
        output = Path(folder) / "core.so"
        command = ["gcc", *FLAGS, f"-I{package / 'include'}", "-o", str(output), str(SOURCE)]
        command += [f"-L{libraries}", f"-l:{LIBRARY}", f"-Wl,-rpath,{libraries}"]
        try:
            done = subprocess.run(
                command, capture_output=True, text=True, timeout=BUILD_TIMEOUT_S, check=False
            )
        except subprocess.TimeoutExpired as error:
            raise BuildError(f"gcc did not end within {BUILD_TIMEOUT_S:g} s") from error
        if done.returncode != 0:
            lines = [line for line in done.stderr.splitlines() if "error" in line]
            raise BuildError(f"{SOURCE.name} does not compile: {(lines or [done.stderr])[0]}")
        library = ctypes.CDLL(str(output))
    library.hk_core_error.restype = ctypes.c_char_p
    return library


class Core:
    """A Cortex-M3 that stands before its first instruction.

    Parameters
    ----------
    image
        The content of the flash.
    happen
        Called when something may be due.
    read, write
        Called with address and number of bytes, and the value, when the program uses an address of
        :meth:`map`.

    Attributes
    ----------
    state
        What is shared with the inner loop.

    Raises
    ------
    EmulationError
        If the image does not fit the flash, or if Unicorn cannot be set up.
    """

    def __init__(
        self, image: bytes, *, flash_bytes: int, happen: Happen, read: Read, write: Write
    ) -> None:
        if not VECTORS_BYTES <= len(image) <= flash_bytes:
            raise EmulationError(
                f"the image has {len(image)} bytes; it must have {VECTORS_BYTES} to {flash_bytes}"
            )
        self._c = _library()
        self._error: BaseException | None = None
        self.state = state = State()
        state.image, state.image_bytes = image, len(image)
        state.happen = _Happen(self._guarded(happen))
        state.read = _Read(self._guarded(read))
        state.write = _Write(self._guarded(write))
        self._self = ctypes.byref(state)
        self._require(self._c.hk_core_open(self._self, flash_bytes, RAM_BYTES))
        weakref.finalize(self, self._c.hk_core_close, self._self)
        self.poke(FLASH_START, image.ljust(flash_bytes, ERASED))
        self.paint()
        self.reset()

    def map(self, start: int, size: int) -> None:
        """Leave a region of addresses to `read` and `write`."""
        self._require(self._c.hk_core_map(self._self, start, size))

    def poke(self, address: int, data: bytes) -> None:
        """Write memory."""
        self._require(self._c.hk_core_poke(self._self, address, data, len(data)))

    def peek(self, address: int, count: int) -> bytes:
        """Read memory."""
        buffer = ctypes.create_string_buffer(count)
        self._require(self._c.hk_core_peek(self._self, address, buffer, count))
        return buffer.raw

    def paint(self) -> None:
        """Fill the RAM with what tells unused stack; a new supply would with anything."""
        self.poke(RAM_START, bytes([PAINT]) * RAM_BYTES)

    def reset(self) -> None:
        """Stand before the first instruction again; memory stays."""
        self._c.hk_core_reset(self._self)

    def update(self) -> None:
        """Find the requests that are new."""
        self._c.hk_core_update(self._self)

    def stop(self) -> None:
        """Stop as soon as the instruction that is carried out has ended."""
        self._c.hk_core_stop(self._self)

    def enter_fault(self) -> None:
        """Let the program's handler of faults take over."""
        self._c.hk_core_enter_fault(self._self)

    def run(self) -> Outcome:
        """Run until the time of the state is reached or until something else ends it.

        Raises
        ------
        Exception
            Whatever `happen`, `read` or `write` raised.
        """
        outcome = Outcome(self._c.hk_core_run(self._self))
        error, self._error = self._error, None
        self.state.failed = 0
        if error is not None:
            raise error
        return outcome

    @property
    def fault_address(self) -> int:
        """Where the last fault was."""
        return self.state.fault_address

    def message(self, number: int) -> str:
        """Return what an error of Unicorn means."""
        return str(self._c.hk_core_error(number).decode("ascii"))

    def _require(self, error: int) -> None:
        if error:
            raise EmulationError(f"unicorn cannot be set up: {self.message(error)}")

    def _guarded(self, function: Callable[..., int | None]) -> Callable[..., int | None]:
        """Keep what a function raises, for C cannot pass it on."""
        own = weakref.ref(self)

        def call(*arguments: int) -> int | None:
            try:
                return function(*arguments)
            except BaseException as error:
                core = own()
                if core is not None and core._error is None:
                    core._error = error
                    core.state.failed = 1
                    core.stop()
                return 0

        return call

    @property
    def stack_bytes(self) -> int:
        """How much stack has been used: all above the longest run of paint that is left."""
        ram = self.peek(RAM_START, RAM_BYTES)
        runs = re.finditer(rb"\x%02x+" % PAINT, ram)
        longest = max(runs, key=lambda run: run.end() - run.start(), default=None)
        return RAM_BYTES - (longest.end() if longest else 0)


@dataclass(slots=True)
class Segments:
    """Instructions between the marks: number of segments, sum and largest."""

    count: int = 0
    total: int = 0
    largest: int = 0

    def add(self, instructions: int) -> None:
        """Take note of one segment."""
        self.count += 1
        self.total += instructions
        self.largest = max(self.largest, instructions)

    @property
    def mean(self) -> float | None:
        """Mean length, or None if there was no segment."""
        return self.total / self.count if self.count else None
