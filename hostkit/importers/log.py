"""What an importer reads out of a file, before it becomes a recording."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hostkit.errors import RecordingError
from hostkit.importers.options import ImportOptions
from hostkit.records import read_only

Vector = NDArray[np.float64]

Progress = Callable[[int, int], None]
"""Called with how much of the work is done, and how much there is."""

MAX_SAMPLES = 50_000_000
"""Most samples of one log: 13 hours at 1 kHz; what claims more is taken for damaged."""


def no_progress(done: int, total: int) -> None:
    """Say nothing."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ReferenceTrack:
    """A reference attitude on its own times.

    Attributes
    ----------
    time_s
        On the clock of the sensor's samples, s, shape ``(M,)``.
    quaternion_wxyz
        Sensor to world with world z up, axes of `hostkit.attitude`, shape ``(M, 4)``; NaN where
        the reference was lost.
    """

    time_s: Vector
    quaternion_wxyz: Vector

    def __post_init__(self) -> None:
        """Check the shapes and make the arrays read-only."""
        if self.quaternion_wxyz.shape != (self.time_s.size, 4):
            raise RecordingError(
                f"the reference has {self.time_s.size} times and quaternions of shape "
                f"{self.quaternion_wxyz.shape}; it must be ({self.time_s.size}, 4)"
            )
        read_only(self.time_s)
        read_only(self.quaternion_wxyz)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SensorLog:
    """Samples of one sensor as a file holds them, in SI units and in hostkit's axes.

    Attributes
    ----------
    time_s
        Time since the first sample, s, shape ``(N,)``; as the file has it, so it may repeat.
    angular_rate_rad_s, specific_force_m_s2
        Shape ``(N, 3)`` each.
    rate_hz
        Nominal rate where the file states one; else it follows from the median time step.
    reference
        Attitude on its own times, if there is one.
    mag_ut, temperature_deg_c, valid
        Shapes ``(N, 3)``, ``(N,)`` and ``(N,)``.
    guessed
        What the file does not say and was concluded from it, one sentence each.
    """

    time_s: Vector
    angular_rate_rad_s: Vector
    specific_force_m_s2: Vector
    rate_hz: float | None = None
    reference: ReferenceTrack | None = None
    mag_ut: Vector | None = None
    temperature_deg_c: Vector | None = None
    valid: NDArray[np.bool_] | None = None
    sensor: str = ""
    licence: str = ""
    guessed: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Check the shapes and make the arrays read-only."""
        samples = self.time_s.size
        if samples > MAX_SAMPLES:
            raise RecordingError(
                f"it has {samples} samples; the limit is {MAX_SAMPLES}: cut it into parts"
            )
        for values in (self.angular_rate_rad_s, self.specific_force_m_s2):
            if values.shape != (samples, 3):
                raise RecordingError(
                    f"it has {samples} times and samples of shape {values.shape}; "
                    f"it must be ({samples}, 3)"
                )
            read_only(values)
        read_only(self.time_s)


@dataclass(frozen=True, slots=True, kw_only=True)
class Importer:
    """One format that can be imported.

    Attributes
    ----------
    name, title
        Name on the command line; what the format is.
    suffixes
        Endings of such files, in small letters.
    sniff
        Tells from the content whether a file is of this format. It never raises.
    read
        Reads a file; raises `RecordingError` if it is damaged or lacks what is needed.
    uses
        Names of the options it takes beyond the common ones.
    generic
        Whether other formats may look like this one: they win then.
    """

    name: str
    title: str
    suffixes: tuple[str, ...]
    sniff: Callable[[Path], bool]
    read: Callable[[Path, ImportOptions, Progress], SensorLog]
    uses: frozenset[str] = frozenset()
    generic: bool = False
