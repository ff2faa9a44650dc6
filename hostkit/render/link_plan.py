"""Which message goes out how often, and whether the link can carry it."""

import math
from dataclasses import dataclass

from hostkit.dialect import FRAME_OVERHEAD_BYTES, HIDDEN_WORDS, payload_bytes, sample_bytes
from hostkit.errors import RenderError
from hostkit.targets import Target

SYSTEM_ID = 1
COMPONENT_ID = 1
MAV_TYPE_GENERIC = 0
MAV_AUTOPILOT_GENERIC = 0
HEARTBEAT_MS = 1000
STATUS_MS = 1000
ATTITUDE_MAX_HZ = 50.0
BITS_PER_BYTE = 10
"""Start bit, eight data bits, stop bit."""
USABLE_SHARE = 0.8
"""The rest is left for events."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StreamedMessage:
    """One message that goes out again and again.

    Attributes
    ----------
    interval_us
        Time between two of them, microseconds; 0 is off.
    frame_bytes
        Its bytes on the link at most.
    """

    name: str
    interval_us: int
    frame_bytes: int


@dataclass(frozen=True, slots=True, kw_only=True)
class LinkPlan:
    """The telemetry of a design: identity, message rates, bytes a second."""

    system_id: int
    component_id: int
    vehicle_type: int
    autopilot: int
    baud: int
    usable_bytes_s: int
    messages: tuple[StreamedMessage, ...]
    bytes_per_s: int


def link_plan(rate_hz: float, target: Target, *, hidden_words: int = 0) -> LinkPlan:
    """Plan the telemetry of a design: every sample, and ATTITUDE at 50 Hz or less.

    Parameters
    ----------
    hidden_words
        Words of the filter's state beside its angles; every sample carries them.

    Raises
    ------
    RenderError
        If the messages do not fit 80 % of the link, or a sample cannot carry the state.
    """
    if hidden_words > HIDDEN_WORDS:
        raise RenderError(
            f"the filter has {hidden_words} words of state beside its angles; "
            f"TILT_SAMPLE carries {HIDDEN_WORDS}"
        )
    attitude_every = max(1, math.ceil(rate_hz / ATTITUDE_MAX_HZ))
    period_us = round(1e6 / rate_hz)
    intervals_us = {
        "TILT_SAMPLE": period_us,
        "ATTITUDE": attitude_every * period_us,
        "SCALED_IMU": 0,
        "RAW_IMU": 0,
        "HIGHRES_IMU": 0,
        "SYS_STATUS": STATUS_MS * 1000,
        "HEARTBEAT": HEARTBEAT_MS * 1000,
    }
    messages = tuple(
        StreamedMessage(
            name=name,
            interval_us=interval_us,
            frame_bytes=FRAME_OVERHEAD_BYTES
            + (sample_bytes(hidden_words) if name == "TILT_SAMPLE" else payload_bytes(name)),
        )
        for name, interval_us in intervals_us.items()
    )
    needed = sum(1e6 / m.interval_us * m.frame_bytes for m in messages if m.interval_us)
    usable = USABLE_SHARE * target.baud / BITS_PER_BYTE
    if target.baud and needed > usable:
        fits_hz = rate_hz * usable / needed
        raise RenderError(
            f"rate_hz = {rate_hz:g} needs {needed:.0f} bytes/s of telemetry; {target.baud} baud "
            f"carries {usable:.0f} bytes/s at 80 % use: about {fits_hz:.0f} Hz fit"
        )
    return LinkPlan(
        system_id=SYSTEM_ID,
        component_id=COMPONENT_ID,
        vehicle_type=MAV_TYPE_GENERIC,
        autopilot=MAV_AUTOPILOT_GENERIC,
        baud=target.baud,
        usable_bytes_s=int(usable),
        messages=messages,
        bytes_per_s=math.ceil(needed),
    )
