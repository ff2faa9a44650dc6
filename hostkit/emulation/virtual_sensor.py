"""The virtual MPU-6050 outside the host target: compiled to WebAssembly or as a shared object."""

import ctypes
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from hostkit.emulation.board import PlannedFault, Stimulus
from hostkit.emulation.tools import require
from hostkit.errors import BuildError

SOURCES = "hk_virtual_*.c"
DEPENDS = "hk_*.[ch]"
BUILT = "build/virtual_mpu6050.wasm"
PREFIX = "hk_virtual_mpu6050_"
TIMEOUT_S = 60.0
COMMON = ("-O2", "-std=c99", "-ffreestanding", "-fno-builtin", "-ffp-contract=off")
WASM = ("--target=wasm32", "-nostdlib", "-Wl,--no-entry", "-Wl,--export-all")
SHARED = ("-shared", "-fPIC")
NEVER = 2**64 - 1
"""Time of an event that does not come."""


def compiled_wasm(folder: Path) -> Path:
    """Return the model that stands in a generated folder as WebAssembly; made if it is not there.

    Raises
    ------
    BuildError
        If it does not compile.
    ToolMissingError
        If clang or its linker is not installed.
    """
    require("clang", "wasm-ld")
    output = folder / BUILT
    newest = max((path.stat().st_mtime_ns for path in folder.glob(DEPENDS)), default=0)
    if output.is_file() and output.stat().st_mtime_ns > newest:
        return output
    output.parent.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory(dir=output.parent) as name:
        aside = Path(name) / output.name
        _compile("clang", *WASM, folder=folder, output=aside)
        aside.replace(output)
    return output


def compile_shared(folder: Path, output: Path) -> None:
    """Compile the model that stands in a generated folder to a shared object.

    Raises
    ------
    BuildError
        If it does not compile.
    ToolMissingError
        If gcc is not installed.
    """
    require("gcc")
    _compile("gcc", *SHARED, folder=folder, output=output)


def _compile(compiler: str, *options: str, folder: Path, output: Path) -> None:
    sources = sorted(str(source) for source in folder.glob(SOURCES))
    if not sources:
        raise BuildError(f"there is no virtual sensor in {folder}: no {SOURCES}")
    command = [compiler, *options, *COMMON, "-o", str(output), *sources]
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, timeout=TIMEOUT_S, check=False
        )
    except subprocess.TimeoutExpired as error:
        raise BuildError(f"{compiler} did not end within {TIMEOUT_S:g} s") from error
    if done.returncode != 0:
        lines = [line for line in done.stderr.splitlines() if "error" in line]
        raise BuildError(
            f"the virtual sensor does not compile: {(lines or [done.stderr.strip()])[0]}"
        )


class VirtualSensor:
    """The virtual sensor in a shared object, for tests; times are in nanoseconds.

    Parameters
    ----------
    library
        What :func:`compile_shared` made.
    stimulus
        What it feels.
    """

    def __init__(self, library: Path, stimulus: Stimulus) -> None:
        self._library = ctypes.CDLL(str(library))
        self._rows = np.frombuffer(stimulus.table(), dtype=np.float64)
        size = self._function("size", ctypes.c_uint32)()
        self._state = ctypes.create_string_buffer(size + 16)
        address = ctypes.addressof(self._state)
        self._self = ctypes.c_void_p(address + -address % 16)
        rows = ctypes.c_void_p(self._rows.ctypes.data)
        self._function("init", None)(
            self._self,
            rows,
            ctypes.c_uint32(len(stimulus)),
            ctypes.c_uint32(stimulus.settle_samples),
            ctypes.c_bool(stimulus.loop),
        )

    def _function(self, name: str, result: type | None) -> "ctypes._NamedFuncPointer":
        function: ctypes._NamedFuncPointer = getattr(self._library, PREFIX + name)
        function.restype = result
        return function

    def set_identity(self, who_am_i: int) -> None:
        """Answer with another identity."""
        self._function("set_identity", None)(self._self, ctypes.c_uint8(who_am_i))

    def nack_next(self, addressings: int) -> None:
        """Do not acknowledge the next addressings."""
        self._function("nack_next", None)(self._self, ctypes.c_uint32(addressings))

    def hold_sda(self, clocks: int) -> None:
        """Hold the data line low until so many clocks have come."""
        self._function("hold_sda", None)(self._self, ctypes.c_uint32(clocks))

    def plan(self, fault: PlannedFault) -> bool:
        """Plan a fault; return whether there was room for it, and such a kind."""
        function = self._function("plan", ctypes.c_bool)
        words = (ctypes.c_uint32(word) for word in (fault.code, fault.row, fault.amount))
        return bool(function(self._self, *words))

    @property
    def struck(self) -> int:
        """Planned faults that have struck so far."""
        return int(self._function("struck", ctypes.c_uint32)(self._self))

    def set_self_test(self, codes: tuple[int, int, int, int]) -> None:
        """Set the factory codes, as the registers SELF_TEST_X to SELF_TEST_A hold them."""
        self._function("set_self_test", None)(self._self, *(ctypes.c_uint8(c) for c in codes))

    def set_response(self, axis: int, share: float) -> None:
        """Let the self-test of an axis answer with a share of the factory trim.

        Axes 0 to 2 are the accelerometer's, 3 to 5 the gyroscope's.
        """
        words = (ctypes.c_uint32(axis), ctypes.c_double(share))
        self._function("set_response", None)(self._self, *words)

    def set_settling(self, settling_ns: int) -> None:
        """Set how long the response of the self-test takes to come."""
        self._function("set_settling", None)(self._self, ctypes.c_uint64(settling_ns))

    def set_ad0(self, *, high: bool) -> None:
        """Set the level of the AD0 pin: the address is 0x68, or 0x69 if it is high."""
        self._function("set_ad0", None)(self._self, ctypes.c_bool(high))

    def feel_motion(self, row_period_ns: int) -> None:
        """Take the rows for motion that is sampled and filtered, one every period."""
        self._function("feel_motion", None)(self._self, ctypes.c_uint64(row_period_ns))

    @property
    def stretch_ns(self) -> int:
        """How long the sensor holds the clock low from now on."""
        return int(self._function("stretch_ns", ctypes.c_uint64)(self._self))

    def clock(self) -> None:
        """Give one clock outside a transaction."""
        self._function("clock", None)(self._self)

    @property
    def sda_low(self) -> bool:
        """Whether the sensor holds the data line low."""
        return bool(self._function("sda_low", ctypes.c_bool)(self._self))

    def advance(self, now_ns: int) -> None:
        """Let time pass."""
        self._function("advance", None)(self._self, ctypes.c_uint64(now_ns))

    def start(self, address: int, *, read: bool) -> bool:
        """Address a device; return whether the sensor acknowledged."""
        function = self._function("start", ctypes.c_bool)
        return bool(function(self._self, ctypes.c_uint8(address), ctypes.c_bool(read)))

    def write(self, byte: int) -> bool:
        """Write a byte; return whether the sensor acknowledged."""
        function = self._function("write", ctypes.c_bool)
        return bool(function(self._self, ctypes.c_uint8(byte)))

    def read(self) -> int:
        """Read a byte."""
        return int(self._function("read", ctypes.c_uint8)(self._self))

    def stop(self) -> None:
        """End the transaction."""
        self._function("stop", None)(self._self)

    @property
    def int_pin(self) -> bool:
        """Level of the interrupt pin."""
        return bool(self._function("int_pin", ctypes.c_bool)(self._self))

    @property
    def int_driven(self) -> bool:
        """Whether the sensor drives the interrupt pin: an open drain that is not low does not."""
        return bool(self._function("int_driven", ctypes.c_bool)(self._self))

    @property
    def announced_ns(self) -> int:
        """When the interrupt pin rose last."""
        return int(self._function("published_ns", ctypes.c_uint64)(self._self))

    @property
    def next_event_ns(self) -> int:
        """When something changes by itself next, or :data:`NEVER`."""
        return int(self._function("next_event_ns", ctypes.c_uint64)(self._self))

    @property
    def exhausted(self) -> bool:
        """Whether the last row has been played and read."""
        return bool(self._function("exhausted", ctypes.c_bool)(self._self))

    @property
    def rows_played(self) -> int:
        """Rows played so far, those of the lead-in not counted."""
        return int(self._function("rows_played", ctypes.c_uint32)(self._self))

    @property
    def unread_samples(self) -> int:
        """Samples that were replaced before they were read."""
        return int(self._function("unread_samples", ctypes.c_uint32)(self._self))
