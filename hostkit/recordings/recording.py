"""The recording: what a sensor measured, in SI units, with a reference where there is one."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import DTypeLike, NDArray

from hostkit.errors import RecordingError
from hostkit.records import read_only

Vector = NDArray[np.float64]

MIN_SAMPLES = 2


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Recording:
    """Samples of one sensor over time.

    Arrays are copied, converted to the types below and made read-only. Only shapes are checked
    here; `hostkit.recordings.require_sound` checks the values.

    Attributes
    ----------
    name
        Short name for reports, without folder and suffix.
    time_s
        Time of each sample, s, shape ``(N,)``.
    rate_hz
        Nominal sample rate.
    angular_rate_rad_s
        What the gyroscope measured, rad/s, sensor axes, shape ``(N, 3)``.
    specific_force_m_s2
        What the accelerometer measured, m/s^2, sensor axes, shape ``(N, 3)``; +9.81 on the axis
        that points up at rest.
    up_reference
        Reference up direction in sensor axes, unit vectors, shape ``(N, 3)``; NaN where the
        reference was lost.
    mag_ut
        Magnetic field, microtesla, shape ``(N, 3)``.
    temperature_deg_c
        Temperature of the sensor, degrees Celsius, shape ``(N,)``.
    valid
        Samples that count for scoring, shape ``(N,)``.
    sensor, origin, licence
        Free texts: what measured, where it comes from, on what terms it may be used.
    sha256
        Digest of the bytes of the file it was read from, hexadecimal; empty if from no file.

    Raises
    ------
    RecordingError
        If there are fewer than two samples, or an array has another shape than it should.
    """

    name: str
    time_s: Vector
    rate_hz: float
    angular_rate_rad_s: Vector
    specific_force_m_s2: Vector
    valid: NDArray[np.bool_]
    up_reference: Vector | None = None
    mag_ut: Vector | None = None
    temperature_deg_c: Vector | None = None
    sensor: str = ""
    origin: str = ""
    licence: str = ""
    sha256: str = ""

    def __post_init__(self) -> None:
        """Check the shapes, copy the arrays and make the copies read-only."""
        samples = np.size(self.time_s)
        if samples < MIN_SAMPLES:
            raise RecordingError(
                f"recording {self.name!r} has {samples} sample(s); it needs at least {MIN_SAMPLES}"
            )
        object.__setattr__(self, "rate_hz", float(self.rate_hz))
        self._own("time_s", (samples,))
        self._own("angular_rate_rad_s", (samples, 3))
        self._own("specific_force_m_s2", (samples, 3))
        self._own("valid", (samples,), np.bool_)
        self._own("up_reference", (samples, 3))
        self._own("mag_ut", (samples, 3))
        self._own("temperature_deg_c", (samples,))

    def _own(self, field: str, shape: tuple[int, ...], kind: DTypeLike = np.float64) -> None:
        given = getattr(self, field)
        if given is None:
            return
        if np.shape(given) != shape:
            raise RecordingError(
                f"recording {self.name!r}: {field} has shape {np.shape(given)}; with {shape[0]} "
                f"time stamps it must be {shape}"
            )
        owned = np.array(given, dtype=kind, order="C")
        read_only(owned)
        object.__setattr__(self, field, owned)

    def __len__(self) -> int:
        return len(self.time_s)

    @property
    def duration_s(self) -> float:
        """Time from the first to the last sample."""
        return float(self.time_s[-1] - self.time_s[0])
