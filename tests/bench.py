"""Parts of the firmware compiled for the host, each to be tested by itself.

`tests/firmware/bench.cdef` names what Python may use of them.
"""

import re
import subprocess
import sysconfig
from collections.abc import Sequence
from importlib import util
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from boards import generated, require_or_skip
from cffi import FFI

from hostkit.records import FilterDesign

SOURCE = Path(__file__).parent / "firmware" / "bench.c"
MODULE = "hk_bench"
PARTS = (
    "hk_calibration",
    "hk_crc",
    "hk_parameter",
    "hk_receiver",
    "hk_store",
    "hk_stream",
    "hk_filter",
    "hk_filter_settings",
    "hk_arctan",
    "hk_units",
)
SLOT_BYTES = 128
NOTHING, SAVED, FAILED, CUT = "NOTHING", "SAVED", "FAILED", "CUT"
"""How a save ends; the supply has failed before the last of them."""
STILL, DONE, MOVED = "NOTHING", "DONE", "MOVED"
"""What the calibration says to a sample."""


def compiled(folder: Path, code: Path) -> Any:
    """Compile the parts of generated code, with checks, to a module with `ffi` and `lib`."""
    include = Path(sysconfig.get_paths()["include"])
    if not (include / "Python.h").exists():
        pytest.skip("Python.h is not installed: sudo apt-get install python3-dev")
    builder = FFI()
    builder.cdef(SOURCE.with_suffix(".cdef").read_text(encoding="ascii"))
    builder.set_source(MODULE, SOURCE.read_text(encoding="ascii"))
    builder.emit_c_code(str(folder / f"{MODULE}.c"))
    library = folder / f"{MODULE}.so"
    sources = [str(code / f"{part}.c") for part in PARTS if (code / f"{part}.c").exists()]
    command = ["gcc", "-std=c99", "-O1", "-g", "-shared", "-fPIC", "-Werror", "-Wall"]
    command += ["-fsanitize=undefined", "-fno-sanitize-recover=all", "-isystem", str(include)]
    command += ["-isystem", str(code / "mavlink"), "-I", str(code), "-o", str(library)]
    command += [str(folder / f"{MODULE}.c"), *sources]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    spec = util.spec_from_file_location(MODULE, library)
    assert spec is not None
    assert spec.loader is not None
    module = util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def two_bytes(number: int) -> np.ndarray:
    return np.frombuffer(number.to_bytes(2, "little"), dtype=np.uint8)


class Bench:
    """The parts of one design's firmware; its memory is erased.

    `limit_bytes_s` is what the link may carry; None is the target's.
    """

    def __init__(
        self, folder: Path, design: FilterDesign | None = None, *, limit_bytes_s: int | None = None
    ) -> None:
        require_or_skip("gcc")
        code = generated("host", folder / "code", design)
        if limit_bytes_s is not None:
            header = code / "hk_design.h"
            text, changes = re.subn(
                r"(HK_LINK_USABLE_BYTES_S +)\d+",
                rf"\g<1>{limit_bytes_s}",
                header.read_text(encoding="ascii"),
            )
            assert changes == 1
            header.write_text(text, encoding="ascii")
        module = compiled(folder, code)
        self.c, self.ffi = module.lib, module.ffi
        assert self.c.HK_STORE_SLOT_BYTES == SLOT_BYTES
        self.supplied = self.c.bench_memory
        self.memory = np.frombuffer(self.ffi.buffer(self.supplied.slots), dtype=np.uint8)
        self.erase()

    def new(self, record: str) -> Any:
        """Return a pointer to a record of C, filled with zeros."""
        return self.ffi.new(f"{record} *")

    def told(self, events: str, event: int) -> str:
        """Return the last word of an event's name."""
        return str(self.ffi.typeof(events).elements[event]).rpartition("_")[2]

    # --- Store --------------------------------------------------------------------------------

    def erase(self) -> None:
        self.memory[:] = 0xFF
        self.supply()

    def supply(
        self, left: int = -1, spoilt: int = 0, *, erases: bool = False, broken: bool = False
    ) -> None:
        memory = self.supplied
        memory.left, memory.spoilt, memory.erases, memory.broken = left, spoilt, erases, broken
        memory.dead, memory.busy = False, 0

    def started(self) -> tuple[Any, Any]:
        """Return store and parameters after a start."""
        store, parameters = self.new("hk_store_t"), self.new("hk_parameters_t")
        self.c.hk_parameters_init(parameters)
        self.c.hk_store_init(store)
        self.c.hk_store_load(store, parameters)
        return store, parameters

    def save(self, place: int, value: float) -> str:
        """Start, set one parameter and save all."""
        return self.save_to(*self.started(), place, value)

    def save_to(self, store: Any, parameters: Any, place: int, value: float) -> str:
        assert self.c.hk_parameter_set(parameters, place, value)
        self.c.hk_store_save(store, parameters)
        event = self.c.HK_STORE_NOTHING
        while event == self.c.HK_STORE_NOTHING and not self.supplied.dead:
            event = self.c.hk_store_poll(store)
        return CUT if self.supplied.dead else self.told("hk_store_event_t", event)

    def load(self, place: int) -> float | None:
        """Return the value of the record that a start would find; None if it finds none."""
        store, parameters = self.started()
        found = self.c.hk_store_valid(store)
        return float(self.c.hk_parameter_get(parameters, place)) if found else None

    def make_generation(self, slot: int, generation: int, end: int | None = None) -> None:
        """Make a valid record one of another generation; with `end`, one with another end."""
        record = self.memory[slot * SLOT_BYTES :]
        values_at, crc_at = self.c.HK_STORE_VALUES_AT, self.c.HK_STORE_CRC_AT
        record[values_at - 2 : values_at] = two_bytes(generation)
        record[crc_at + 2 : crc_at + 4] = two_bytes(generation if end is None else end)
        crc = self.c.HK_CRC_START
        for byte in record[:crc_at]:
            crc = self.c.hk_crc(crc, int(byte))
        record[crc_at : crc_at + 2] = two_bytes(crc)

    # --- Parameters ---------------------------------------------------------------------------

    def place(self, name: str) -> int:
        field = self.ffi.new("char[]", name.encode().ljust(self.c.HK_NAME_BYTES, b"\0"))
        return int(self.c.hk_parameter_find(field))

    def set(self, name: str, value: float) -> tuple[bool, float, bool]:
        """Set one of the design's parameters.

        Return whether the value was taken, what is in use then, and whether that is retuned.
        """
        parameters, place = self.new("hk_parameters_t"), self.place(name)
        self.c.hk_parameters_init(parameters)
        taken = self.c.hk_parameter_set(parameters, place, value)
        used = self.c.hk_parameter_get(parameters, place)
        return taken, used, self.c.hk_parameters_retuned(parameters)


class Streams:
    """The schedule of the messages, each by its name in HK_MESSAGE_PLAN."""

    def __init__(self, bench: Bench, start_us: int = 0) -> None:
        self._c = bench.c
        names = [name for name in dir(bench.c) if name.startswith("HK_STREAM_")]
        assert len(names) == bench.c.HK_STREAMS
        self._which = {name.removeprefix("HK_STREAM_"): getattr(bench.c, name) for name in names}
        self._name = {which: name for name, which in self._which.items()}
        self.state = bench.new("hk_stream_t")
        self._c.hk_stream_init(self.state, start_us)

    def every(self, name: str, interval_us: int) -> bool:
        """Ask for a message ever so often; return whether that was accepted."""
        return bool(self._c.hk_stream_set(self.state, self._which[name], interval_us, 0))

    def request(self, name: str) -> None:
        self._c.hk_stream_request(self.state, self._which[name])

    def sample(self) -> None:
        self._c.hk_stream_sample(self.state)

    def time(self, now_us: int) -> None:
        self._c.hk_stream_time(self.state, now_us)

    def due(self) -> list[str]:
        """Take all messages that are due, in order."""
        taken = []
        while (which := self._c.hk_stream_next(self.state)) != self._c.HK_NO_STREAM:
            self._c.hk_stream_sent(self.state, which)
            taken.append(self._name[which])
        return taken


class Calibration:
    """A calibration that has been asked for."""

    def __init__(self, bench: Bench, start_us: int = 0) -> None:
        self._bench = bench
        self.state = bench.new("hk_calibration_t")
        self.mean = bench.ffi.new("float[3]")
        bench.c.hk_calibration_init(self.state)
        bench.c.hk_calibration_start(self.state, start_us)

    def take(self, accel: Sequence[float], gyro: Sequence[float]) -> str:
        """Give it one sample of whole counts; DONE leaves the mean."""
        counts = [self._bench.ffi.new("int16_t[3]", [int(x) for x in v]) for v in (accel, gyro)]
        return self._told(self._bench.c.hk_calibration_take(self.state, *counts, self.mean))

    def poll(self, now_us: int) -> str:
        return self._told(self._bench.c.hk_calibration_poll(self.state, now_us))

    def drop(self) -> None:
        self._bench.c.hk_calibration_drop(self.state)

    def _told(self, event: int) -> str:
        return self._bench.told("hk_calibration_event_t", event)


class Receiver:
    """A receiver that has not heard anything."""

    def __init__(self, bench: Bench) -> None:
        self._c = bench.c
        self.state = bench.new("hk_receiver_t")
        self._c.hk_receiver_init(self.state)

    def take(self, data: bytes) -> list[int]:
        """Return the identities of the messages that it finds."""
        return [self.state.id for byte in data if self._c.hk_receiver_take(self.state, byte)]
