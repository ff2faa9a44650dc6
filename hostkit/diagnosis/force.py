"""How much the specific force says besides gravity: vibration, and its distance to 1 g."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import welch

from hostkit.recordings import Recording
from hostkit.recordings.recording import Vector
from hostkit.records import read_only
from hostkit.units import STANDARD_GRAVITY_M_S2

VIBRATION_FROM_HZ = 10.0
"""People and joints move more slowly than this; motors and footfalls shake faster."""
SEGMENT = 1024
MIN_SAMPLES = 64
MIN_LINES = 3
PERCENTILES = (50.0, 75.0, 90.0, 95.0, 99.0)
DEVIATION_LIMIT_G = 0.5
BINS = 100

Triple = tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Spectrum:
    """Power spectral density of the specific force.

    Attributes
    ----------
    frequency_hz
        Shape ``(F,)``.
    density
        (m/s^2)^2/Hz, one-sided, sensor axes, shape ``(F, 3)``.
    """

    frequency_hz: Vector
    density: Vector

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        read_only(self.frequency_hz)
        read_only(self.density)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ForceLevel:
    """What the accelerometer measures besides gravity.

    Attributes
    ----------
    spectrum
        None if there are fewer than 64 samples.
    vibration_m_s2
        Root mean square above `VIBRATION_FROM_HZ` per axis; None without a spectrum or where the
        sample rate does not reach that far.
    vibration_total_m_s2
        Root of the sum of their squares.
    deviation_percentiles_g
        Of ``| |f| - 1 g |``, at `PERCENTILES`: what a gate of that width lets through.
    deviation_median_g
        Median of ``|f| - 1 g`` with its sign: a scale error shows here.
    edges_g, counts
        Histogram of ``|f| - 1 g`` from -0.5 to 0.5 g, shapes ``(B + 1,)`` and ``(B,)``; what is
        outside is in the outermost bins.
    """

    spectrum: Spectrum | None
    vibration_m_s2: Triple | None
    vibration_total_m_s2: float | None
    deviation_percentiles_g: tuple[float, ...]
    deviation_median_g: float
    edges_g: Vector
    counts: NDArray[np.int64]

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        read_only(self.edges_g)
        read_only(self.counts)


def force_level(recording: Recording) -> ForceLevel:
    """Return what the accelerometer of a recording measures besides gravity."""
    magnitude = np.linalg.norm(recording.specific_force_m_s2, axis=1)
    deviation_g = magnitude / STANDARD_GRAVITY_M_S2 - 1.0
    held = np.clip(deviation_g, -DEVIATION_LIMIT_G, DEVIATION_LIMIT_G)
    counts, edges_g = np.histogram(held, BINS, (-DEVIATION_LIMIT_G, DEVIATION_LIMIT_G))
    spectrum = _spectrum(recording)
    shaking = None if spectrum is None else _shaking(spectrum)
    return ForceLevel(
        spectrum=spectrum,
        vibration_m_s2=shaking,
        vibration_total_m_s2=None if shaking is None else float(np.linalg.norm(shaking)),
        deviation_percentiles_g=tuple(np.percentile(np.abs(deviation_g), PERCENTILES).tolist()),
        deviation_median_g=float(np.median(deviation_g)),
        edges_g=edges_g,
        counts=counts.astype(np.int64),
    )


def _spectrum(recording: Recording) -> Spectrum | None:
    """Estimate the density by averaged periodograms (P. D. Welch, IEEE Trans. AU-15, 1967)."""
    if len(recording) < MIN_SAMPLES:
        return None
    frequency_hz, density = welch(
        recording.specific_force_m_s2,
        recording.rate_hz,
        nperseg=min(SEGMENT, len(recording)),
        axis=0,
    )
    return Spectrum(frequency_hz=np.asarray(frequency_hz), density=np.asarray(density))


def _shaking(spectrum: Spectrum) -> Triple | None:
    above = spectrum.frequency_hz >= VIBRATION_FROM_HZ
    if np.count_nonzero(above) < MIN_LINES:
        return None
    width_hz = float(spectrum.frequency_hz[1] - spectrum.frequency_hz[0])
    x, y, z = np.sqrt(spectrum.density[above].sum(axis=0) * width_hz).tolist()
    return x, y, z
