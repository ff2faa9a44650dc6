"""Parts of the firmware compiled for the host, each to be tested by itself."""

import ctypes
import re
import subprocess
from pathlib import Path

import numpy as np
from boards import generated, require_or_skip

from hostkit.records import FilterDesign

SOURCE = Path(__file__).parent / "firmware" / "bench.c"
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
NOTHING, SAVED, FAILED, CUT = 0, 1, 2, -1
"""How a save ends."""


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
        library = folder / "bench.so"
        sources = [str(code / f"{part}.c") for part in PARTS if (code / f"{part}.c").exists()]
        command = ["gcc", "-std=c99", "-O1", "-g", "-shared", "-fPIC", "-Werror", "-Wall"]
        command += ["-fsanitize=undefined", "-fno-sanitize-recover=all"]
        command += ["-isystem", str(code / "mavlink"), "-I", str(code), "-o", str(library)]
        subprocess.run([*command, str(SOURCE), *sources], check=True, timeout=120)
        self.c = ctypes.CDLL(str(library))
        self.c.bench_memory.restype = ctypes.POINTER(ctypes.c_uint8)
        self.c.bench_written.restype = ctypes.c_ulong
        self.record_bytes = int(self.c.bench_record_bytes())
        self.memory = np.ctypeslib.as_array(self.c.bench_memory(), (2 * SLOT_BYTES,))
        self.erase()

    def erase(self) -> None:
        self.memory[:] = 0xFF
        self.supply()

    def supply(
        self, left: int = -1, spoilt: int = 0, *, erases: bool = False, broken: bool = False
    ) -> None:
        self.c.bench_supply(ctypes.c_long(left), spoilt, int(erases), int(broken))

    def save(self, place: int, value: float) -> int:
        return int(self.c.bench_save(place, ctypes.c_float(value)))

    def load(self, place: int) -> float | None:
        """Return the value of the record that a start would find; None if it finds none."""
        value = ctypes.c_float()
        found = self.c.bench_load(place, ctypes.byref(value))
        return value.value if found else None

    def place(self, name: str) -> int:
        return int(self.c.bench_find(name.encode()))

    def set(self, name: str, value: float) -> tuple[bool, float, bool]:
        """Return whether a value was taken, what is in use then, and whether that is retuned."""
        used, retuned = ctypes.c_float(), ctypes.c_int()
        taken = self.c.bench_set(
            self.place(name), ctypes.c_float(value), ctypes.byref(used), ctypes.byref(retuned)
        )
        return bool(taken), used.value, bool(retuned.value)

    def due(self) -> list[int]:
        """Take all messages that are due, in order."""
        return list(iter(self.c.bench_stream_take, -1))

    def take(self, accel: object, gyro: object) -> tuple[int, list[float]]:
        """Give the calibration one sample; return its event and its mean."""
        counts = [np.asarray(x, dtype=np.int16) for x in (accel, gyro)]
        mean = (ctypes.c_float * 3)()
        pointers = [x.ctypes.data_as(ctypes.c_void_p) for x in counts]
        event = self.c.bench_calibration_take(*pointers, mean)
        return int(event), list(mean)

    def receive(self, data: bytes) -> list[int]:
        """Return the identities of the messages that a new receiver finds."""
        ids = (ctypes.c_uint16 * 1000)()
        found = self.c.bench_receive(data, len(data), ids, 1000)
        return list(ids[:found])

    @property
    def receiver_errors(self) -> int:
        return int(self.c.bench_receiver_errors())
