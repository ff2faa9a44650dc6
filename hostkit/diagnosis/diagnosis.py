"""The diagnosis of a recording: all that it shows of its sensor and its motion."""

from dataclasses import dataclass

import numpy as np

from hostkit.diagnosis.clipping import Reach, reach
from hostkit.diagnosis.force import ForceLevel, force_level
from hostkit.diagnosis.noise import SensorNoise, sensor_noise
from hostkit.diagnosis.planarity import Planarity, planarity
from hostkit.diagnosis.rest import Rest, rest
from hostkit.diagnosis.timing import Timing, timing
from hostkit.mounting import Mounting
from hostkit.recordings import Recording, require_sound
from hostkit.records import AxisChoice

DEFAULT_MOUNTING = Mounting()


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Diagnosis:
    """What a recording shows, for one choice of axes and mounting.

    Attributes
    ----------
    name, samples, rate_hz, duration_s
        Of the recording.
    axes, mounting
        What `planarity` was asked about.
    temperature_deg_c
        Least and greatest temperature; None where none was recorded.
    noise
        None if it was not asked for, or no rest is long enough.
    """

    name: str
    samples: int
    rate_hz: float
    duration_s: float
    axes: AxisChoice
    mounting: Mounting
    timing: Timing
    reach: Reach
    rest: Rest
    temperature_deg_c: tuple[float, float] | None
    force: ForceLevel
    planarity: Planarity
    noise: SensorNoise | None = None


def diagnose(
    recording: Recording,
    *,
    axes: AxisChoice = "both",
    mounting: Mounting = DEFAULT_MOUNTING,
    noise: bool = False,
) -> Diagnosis:
    """Diagnose a recording.

    Parameters
    ----------
    recording
        One that `hostkit.recordings.load` returned, or that `require_sound` lets through.
    axes, mounting
        The filter that is to be tuned.
    noise
        Whether to compute Allan deviations too, about a second for 65,000 samples at rest.

    Raises
    ------
    RecordingError
        If a value is not finite or the time does not rise.
    ToolMissingError
        If Allan deviations are asked for, there is rest enough, and allantools is not installed.
    """
    _require_usable(recording)
    at_rest = rest(recording)
    bias = np.array(at_rest.bias_rad_s or (0.0, 0.0, 0.0))
    return Diagnosis(
        name=recording.name,
        samples=len(recording),
        rate_hz=recording.rate_hz,
        duration_s=recording.duration_s,
        axes=axes,
        mounting=mounting,
        timing=timing(recording),
        reach=reach(recording),
        rest=at_rest,
        temperature_deg_c=_temperature(recording),
        force=force_level(recording),
        planarity=planarity(recording, axes=axes, mounting=mounting, bias_rad_s=bias),
        noise=sensor_noise(recording, at_rest) if noise else None,
    )


def _require_usable(recording: Recording) -> None:
    """Leave the refusal, and its words, to the check that all files pass; that one takes longer."""
    arrays = (recording.time_s, recording.angular_rate_rad_s, recording.specific_force_m_s2)
    finite = all(bool(np.isfinite(array).all()) for array in arrays)
    positive = np.isfinite(recording.rate_hz) and recording.rate_hz > 0.0
    if not (finite and positive and bool((np.diff(recording.time_s) > 0.0).all())):
        require_sound(recording)


def _temperature(recording: Recording) -> tuple[float, float] | None:
    if recording.temperature_deg_c is None:
        return None
    known = recording.temperature_deg_c[np.isfinite(recording.temperature_deg_c)]
    return (float(known.min()), float(known.max())) if known.size else None
