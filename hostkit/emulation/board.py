"""What an emulated board takes and gives: the records that all boards share."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hostkit.errors import EmulationError
from hostkit.records import read_only

Vector = NDArray[np.float64]
Progress = Callable[[int], None]
Send = Callable[[bytes], None]
Stop = Callable[[], bool]
Receive = Callable[[], bytes]
"""Gives the bytes that have come for the board since it was last asked; none is the empty text."""


def nothing_received() -> bytes:
    """Return no bytes: what comes over a link that nobody talks into."""
    return b""


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannedFault:
    """A fault by its code in the virtual sensor, and the row at whose sampling it strikes."""

    code: int
    row: int
    amount: int


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorFaults:
    """What goes wrong on the virtual sensor.

    Attributes
    ----------
    who_am_i
        The identity it answers with; None is its own.
    nack
        So many addressings are not acknowledged.
    hold_sda_clocks
        The data line is held low until so many clocks have come.
    from_row
        The last two begin when so many rows have been played.
    planned
        Faults that the virtual sensor carries out by itself, each at its row.
    """

    who_am_i: int | None = None
    nack: int = 0
    hold_sda_clocks: int = 0
    from_row: int = 0
    planned: tuple[PlannedFault, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class LinkInput:
    """Bytes that are sent to the board's link, from a time of the run on, s."""

    time_s: float
    data: bytes


@dataclass(frozen=True, slots=True, kw_only=True)
class Stimulus:
    """What the virtual sensor feels, one row per output sample, in sensor axes.

    Attributes
    ----------
    angular_rate_rad_s, specific_force_m_s2
        Each of shape ``(N, 3)``.
    temperature_deg_c
        Shape ``(N,)``.
    settle_samples
        Samples that the driver drops after it has enabled data-ready. So often row 0 is played
        before the table begins, so that the first sample that is not dropped is row 0.
    loop
        Whether the table starts again at its end. `run` needs an end; `serve` always loops.
    faults
        What goes wrong.
    received
        What the link receives, in order of time. `run` plays it; `serve` asks for it instead.
    store
        What the non-volatile store of the board holds at the start, from its first byte on; the
        rest of it is erased.
    power_cut_after
        Once the firmware has written so many bytes to the non-volatile store, the supply of the
        board fails within the next: that byte is spoilt, and the board starts again. None: never.
    """

    angular_rate_rad_s: Vector
    specific_force_m_s2: Vector
    temperature_deg_c: Vector
    settle_samples: int = 0
    loop: bool = False
    faults: SensorFaults = SensorFaults()
    received: tuple[LinkInput, ...] = ()
    store: bytes = b""
    power_cut_after: int | None = None

    def __post_init__(self) -> None:
        """Refuse shapes that do not belong together and values that are not finite."""
        samples = len(self.angular_rate_rad_s)
        for name, array, shape in (
            ("angular_rate_rad_s", self.angular_rate_rad_s, (samples, 3)),
            ("specific_force_m_s2", self.specific_force_m_s2, (samples, 3)),
            ("temperature_deg_c", self.temperature_deg_c, (samples,)),
        ):
            if array.shape != shape or samples == 0:
                raise EmulationError(f"{name} has the shape {array.shape}; it must be {shape}, N>0")
            if not np.isfinite(array).all():
                raise EmulationError(f"{name} holds a value that is not finite")
            read_only(array)

    def __len__(self) -> int:
        return len(self.angular_rate_rad_s)

    def table(self) -> bytes:
        """Return the rows as the virtual sensor reads them: seven little-endian float64 each."""
        columns = (
            self.angular_rate_rad_s,
            self.specific_force_m_s2,
            self.temperature_deg_c[:, None],
        )
        return np.hstack(columns).astype("<f8").tobytes()


@dataclass(frozen=True, slots=True, kw_only=True)
class BoardRun:
    """What a board did with a stimulus.

    Attributes
    ----------
    stream
        Every byte of its link.
    cycles_mean, cycles_max
        Cost of one filter update without interrupts; None where nothing counts it.
    cost_unit
        What that cost is counted in: clock ``cycles``, or ``instructions`` where the emulator
        knows no cycles.
    stack_bytes
        Deepest stack; None where nothing measures it.
    faults
        What went wrong, by name: ``unread_samples`` that the firmware did not read in time,
        ``stalled`` if it stopped taking samples, ``struck`` planned faults, ``resets`` of the
        processor by its watchdog, on request or after a power cut.
    store
        What the non-volatile store holds at the end.
    """

    stream: bytes
    cycles_mean: float | None = None
    cycles_max: float | None = None
    cost_unit: str = "cycles"
    stack_bytes: int | None = None
    faults: tuple[tuple[str, int], ...] = ()
    store: bytes = b""


@dataclass(frozen=True, slots=True, kw_only=True)
class BuildResult:
    """A built image: the file, and what it takes in flash and static RAM (None on a host)."""

    artifact: Path
    flash_bytes: int | None = None
    ram_bytes: int | None = None
