"""Where the numbers of a design come from: tuning and calibration, with their recordings."""

from dataclasses import dataclass
from typing import Final, Literal

Objective = Literal["rmse", "mae"]
TermKind = Literal["gyro_bias", "gyro_scale", "accel_offset", "accel_scale"]

OBJECTIVES: Final[tuple[Objective, ...]] = ("rmse", "mae")
TERM_UNITS: Final[dict[TermKind, str]] = {
    "gyro_bias": "rad/s",
    "gyro_scale": "1",
    "accel_offset": "m/s^2",
    "accel_scale": "1",
}
"""Kinds of calibration terms in the order in which they are shown, with their units."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordingDigest:
    """What a design remembers of a recording it was tuned on."""

    name: str
    sha256: str
    samples: int


@dataclass(frozen=True, slots=True, kw_only=True)
class TuningRecord:
    """How a design was found, so that it can be found again.

    `rmse_deg` is the figure on the recordings named here, that is, a training figure;
    `held_out_rmse_deg` is the one on recordings while they were left out.
    """

    objective: Objective
    optimiser: str
    seed: int
    particles: int
    iterations: int
    evaluations: int
    rmse_deg: float
    recordings: tuple[RecordingDigest, ...]
    versions: tuple[tuple[str, str], ...]
    held_out_rmse_deg: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class CalibrationTerm:
    """One number of a calibration: what an axis of a sensor reads wrong.

    The true value is ``(1 + scale) * (reading - offset)``, with the bias for the offset of the
    gyroscope.

    Attributes
    ----------
    kind
        What it is, one of `TERM_UNITS`, which has its unit.
    axis
        Sensor axis: 0, 1, 2 for x, y, z.
    value, standard_error
        The number and its standard error, in the unit of the kind.
    """

    kind: TermKind
    axis: int
    value: float
    standard_error: float

    @property
    def name(self) -> str:
        """Kind and axis, such as ``gyro_bias_x``."""
        return f"{self.kind}_{'xyz'[self.axis]}"


@dataclass(frozen=True, slots=True, kw_only=True)
class CalibrationRecord:
    """How the sensor of a design was calibrated.

    Attributes
    ----------
    gravity_m_s2
        Magnitude of gravity that was assumed.
    poses, turns
        Positions at rest, and motions between two of them, that were used.
    terms
        What was found, in sensor axes; also what the filter of the design cannot use.
    recordings
        What it was found on.
    temperature_c, temperature_low_c, temperature_high_c
        Mean, least and greatest temperature at rest; None where no recording has it.
    force_before_m_s2, force_after_m_s2
        Rms difference of the force at rest to gravity; None where the accelerometer was left out.
    turn_before_deg, turn_after_deg
        Rms angle between gravity carried on by the gyroscope and gravity as measured after a turn;
        None where the scale of the gyroscope was left out.
    """

    gravity_m_s2: float
    poses: int
    turns: int
    terms: tuple[CalibrationTerm, ...]
    recordings: tuple[RecordingDigest, ...]
    temperature_c: float | None = None
    temperature_low_c: float | None = None
    temperature_high_c: float | None = None
    force_before_m_s2: float | None = None
    force_after_m_s2: float | None = None
    turn_before_deg: float | None = None
    turn_after_deg: float | None = None
