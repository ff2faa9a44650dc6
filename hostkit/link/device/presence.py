"""Who is on a link: devices, ground stations, and what the samples of a device tell of it."""

from collections import Counter
from dataclasses import dataclass, field
from typing import Final

from hostkit.errors import DeviceError
from hostkit.link.frames.decoder import Frame, Source, digest_of
from hostkit.link.frames.framing import FLAGS_AT, SIGNED
from hostkit.link.statistics import LinkStatistics

MOST_SOURCES = 64
MOST_SHOWN = 8
LEAST_PERIODS: Final = 10
"""Sample periods from which on the rate is told."""

GROUND_STATION = 6
"""MAV_TYPE_GCS."""


@dataclass(slots=True, kw_only=True)
class Presence:
    """The senders that were heard.

    Attributes
    ----------
    system
        The only system that counts; None where all do.
    heard
        Heartbeats of senders that are no ground station, of 64 senders at most.
    sampling
        The first sender of a TILT_SAMPLE.
    digest
        Of its design.
    signed
        Whether the latest heartbeat or sample of a device was signed.
    """

    system: int | None = None
    heard: Counter[Source] = field(default_factory=Counter)
    sampling: Source | None = None
    digest: str | None = None
    signed: bool = False
    _first: tuple[int, int] | None = None
    _latest: tuple[int, int] | None = None

    @property
    def rate_hz(self) -> float | None:
        """Sample rate by the device's own time; None while too little has come."""
        if self._first is None or self._latest is None:
            return None
        periods = self._latest[0] - self._first[0]
        time_us = self._latest[1] - self._first[1]
        return periods * 1e6 / time_us if periods >= LEAST_PERIODS and time_us > 0 else None

    def begin_epoch(self) -> None:
        """Take note that the port was opened anew: the device's time may be another."""
        self._first = None

    def take(self, frame: Frame) -> bool:
        """Take any frame that came; tell whether it is of a system that counts."""
        if self.system not in (None, frame.source[0]):
            return False
        if frame.name == "HEARTBEAT" and int(frame.message.type) != GROUND_STATION:
            if frame.source in self.heard or len(self.heard) < MOST_SOURCES:
                self.heard[frame.source] += 1
                self.signed = _is_signed(frame)
        elif frame.name == "TILT_SAMPLE":
            self._take_sample(frame)
        return True

    def device(self) -> Source:
        """Return who is meant: the sender of samples, or the only one.

        Raises
        ------
        DeviceError
            If several may be.
        """
        if self.sampling is not None:
            return self.sampling
        if len(self.heard) > 1:
            shown = sorted(self.heard)[:MOST_SHOWN]
            said = ", ".join(f"{system}/{component}" for system, component in shown)
            said += ", ..." if len(self.heard) > MOST_SHOWN else ""
            raise DeviceError(
                f"several systems are on the link (system/component {said}) and none sends "
                "samples; choose one with --system"
            )
        return next(iter(self.heard))

    def nobody(self, waited_s: float, link: LinkStatistics) -> str:
        """Say what was heard instead of a device."""
        if link.bad_signatures:
            return (
                f"{link.bad_signatures} messages were refused: they are not signed with this key, "
                "or not newly; give the key that the device has"
            )
        if self.system is not None and link.frames:
            return f"system {self.system} was not heard in {waited_s:g} s, but others were"
        if link.frames:
            return f"MAVLink came in {waited_s:g} s, but no device: no sample and no heartbeat"
        if link.received_bytes:
            return "bytes come that are not MAVLink 2; is the --baud rate that of the device?"
        return f"nothing was received in {waited_s:g} s; is the device powered and wired?"

    def _take_sample(self, frame: Frame) -> None:
        if self.sampling is None:
            self.sampling = frame.source
        if frame.source != self.sampling:
            return
        self.digest, self.signed = digest_of(frame), _is_signed(frame)
        now = (int(frame.message.sequence), int(frame.message.time_usec))
        if self._first is None or self._latest is None or now[0] < self._latest[0]:
            self._first = now
        self._latest = now


def _is_signed(frame: Frame) -> bool:
    return bool(frame.raw[FLAGS_AT] & SIGNED)
