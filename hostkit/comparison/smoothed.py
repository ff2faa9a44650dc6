"""hostkit's smoother in a comparison, beside the offline peers."""

from collections.abc import Iterator
from dataclasses import fields

from hostkit.comparison.row import Row
from hostkit.errors import RecordingError
from hostkit.mounting import Mounting
from hostkit.recordings import Recording
from hostkit.records import Parameter
from hostkit.smoothing import SmootherSettings, smooth
from hostkit.tuning.evaluation import Quantity
from hostkit.tuning.track import scored_rms_rad, track_of

UNITS = {
    "rad_s_rthz": "rad/s/rtHz",
    "rad_s_rts": "rad/s/rts",
    "m_s2_rthz": "m/s^2/rtHz",
    "rad_s": "rad/s",
    "m_s2": "m/s^2",
    "m_s": "m/s",
    "_m": "m",
    "_s": "s",
}
"""Units by the end of a name, the longer ends first."""


def smoother_row(
    recordings: tuple[Recording, ...], quantity: Quantity, mounting: Mounting, lead_s: float
) -> Iterator[Row]:
    """Smooth recordings with the settings of an ordinary sensor; nothing where one is too short.

    Parameters
    ----------
    lead_s
        How far the angles are told ahead; the smoother takes none below zero.
    """
    settings = SmootherSettings(lead_s=max(lead_s, 0.0))
    try:
        each = tuple(_rms_rad(one, quantity, mounting, settings) for one in recordings)
    except RecordingError:
        return
    yield Row(
        name="smooth",
        title="hostkit smooth",
        origin="hostkit",
        settings="default",
        is_offline=True,
        lead_s=settings.lead_s,
        each_rad=each,
        parameters=tuple(
            Parameter(name=f.name, value=getattr(settings, f.name), unit=_unit(f.name))
            for f in fields(settings)
        ),
    )


def _rms_rad(
    recording: Recording, quantity: Quantity, mounting: Mounting, settings: SmootherSettings
) -> float:
    track = track_of(recording)
    found = smooth(track.rate_rad_s, track.force_m_s2, 1.0 / recording.rate_hz, settings)
    return scored_rms_rad(track, track.deviation_rad(found.up, quantity, mounting), 0, None)


def _unit(name: str) -> str:
    return next((unit for end, unit in UNITS.items() if name.endswith(end)), "1")
