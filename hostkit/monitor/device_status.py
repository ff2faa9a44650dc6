"""What the devices on a link say of themselves, cleaned for showing."""

from collections import deque
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from hostkit.dialect import python_module
from hostkit.link.frames.decoder import Frame, Source
from hostkit.monitor.snapshot import DeviceStatus
from hostkit.sensors.mpu6050 import TEMPERATURE_COUNTS_PER_DEG_C, TEMPERATURE_OFFSET_DEG_C

TEXTS_KEPT = 20
TEXT_LENGTH = 50
MOST_SOURCES = 16
"""Senders whose state is kept; a hostile stream may claim all 65025."""

US_PER_S = 1e6
TOLD_BY = frozenset(("HEARTBEAT", "SYS_STATUS", "STATUSTEXT", "AUTOPILOT_VERSION"))
UNKNOWN_LOAD = 0xFFFF


def printable(text: str) -> str:
    """Return a text of the link in one line that no terminal acts upon."""
    line = text.split("\0", 1)[0][:TEXT_LENGTH]
    return "".join(c if c.isprintable() else "?" for c in line).strip()


Raw = TypeVar("Raw", float, NDArray[np.float64])


def deg_c(raw: Raw) -> Raw:
    """Return the temperature that a TILT_SAMPLE tells, degrees Celsius."""
    return raw / TEMPERATURE_COUNTS_PER_DEG_C + TEMPERATURE_OFFSET_DEG_C


class DeviceWatch:
    """Follows what one sender says of itself."""

    def __init__(self, source: Source) -> None:
        self._source = source
        self._state: str | None = None
        self._version: str | None = None
        self._load_percent: float | None = None
        self._healthy: bool | None = None
        self._texts: deque[str] = deque(maxlen=TEXTS_KEPT)
        self._sample: Frame | None = None

    def take(self, frame: Frame) -> None:
        """Take any message of this sender."""
        if frame.name == "TILT_SAMPLE":
            self._sample = frame
            return
        if frame.name not in TOLD_BY:
            return
        message = frame.message
        if frame.name == "HEARTBEAT":
            self._state = _state_name(message.system_status)
        elif frame.name == "SYS_STATUS":
            self._take_health(message)
        elif frame.name == "STATUSTEXT":
            self._texts.append(printable(str(message.text)))
        elif frame.name == "AUTOPILOT_VERSION":
            number = message.flight_sw_version
            self._version = ".".join(str(number >> shift & 0xFF) for shift in (24, 16, 8))

    def _take_health(self, message: Any) -> None:
        load = message.load
        self._load_percent = None if load == UNKNOWN_LOAD else load / 10.0
        wanted = message.onboard_control_sensors_enabled
        self._healthy = message.onboard_control_sensors_health & wanted == wanted

    @property
    def last_text(self) -> str:
        """The latest status text, empty if there was none."""
        return self._texts[-1] if self._texts else ""

    def status(self) -> DeviceStatus:
        """Return all that was said."""
        sample = None if self._sample is None else self._sample.message
        return DeviceStatus(
            system=self._source[0],
            component=self._source[1],
            state=self._state,
            version=self._version,
            uptime_s=None if sample is None else sample.time_usec / US_PER_S,
            temperature_deg_c=None if sample is None else deg_c(float(sample.temperature)),
            load_percent=self._load_percent,
            healthy=self._healthy,
            bus_errors=None if sample is None else sample.i2c_errors,
            texts=tuple(self._texts),
        )


def _state_name(number: int) -> str:
    entry = python_module().enums["MAV_STATE"].get(number)
    return str(entry.name).removeprefix("MAV_STATE_") if entry else f"STATE {number}"


class Watches:
    """What every sender says of itself, of a bounded number of them."""

    def __init__(self) -> None:
        self._of: dict[Source, DeviceWatch] = {}
        self.last_text = ""

    def take(self, frame: Frame) -> None:
        """Take any message; those of senders past the bound are passed over."""
        watch = self._of.get(frame.source)
        if watch is None:
            if len(self._of) >= MOST_SOURCES:
                return
            watch = self._of[frame.source] = DeviceWatch(frame.source)
        watch.take(frame)
        if frame.name == "STATUSTEXT":
            self.last_text = watch.last_text

    def status(self, source: Source | None) -> DeviceStatus:
        """Return what one sender says; of the first if none is chosen yet."""
        if source is None:
            source = next(iter(self._of), None)
        watch = None if source is None else self._of.get(source)
        return DeviceStatus() if watch is None else watch.status()
