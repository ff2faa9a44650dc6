"""A live session: bytes from a port, through the decoder, into the validator, to a verdict."""

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol

from hostkit.design_file import digest
from hostkit.errors import DeviceError
from hostkit.link.decoder import Decoder, Frame, Source, digest_of, trace_of
from hostkit.link.transport import Transport
from hostkit.monitor.result import SessionResult
from hostkit.records import AXES, FilterDesign
from hostkit.validation import Thresholds, Validator

POLL_S = 0.1
SILENCE_S = 5.0
"""How long a live port may stay without a sample before the session gives up."""

TEXT_SHARE = 0.9
"""Share of printable bytes from which on noise is taken for text."""


class Clock(Protocol):
    """A source of time."""

    def monotonic(self) -> float:
        """Return seconds that only rise."""

    def time(self) -> float:
        """Return seconds since 1970."""


class SystemClock:
    """The clock of the machine."""

    def monotonic(self) -> float:
        """Return seconds that only rise."""
        return time.monotonic()

    def time(self) -> float:
        """Return seconds since 1970."""
        return time.time()


class Recorder(Protocol):
    """Takes every frame that was received."""

    def write(self, time_us: int, frame: bytes) -> None:
        """Keep one frame."""


@dataclass(slots=True, kw_only=True)
class Session:
    """One device under validation.

    Attributes
    ----------
    duration_s
        How long to look at samples, counted from the first; None until the stream ends.
    recorder
        Where every good frame goes.
    progress
        Called after each batch of samples with the session.
    """

    design: FilterDesign
    transport: Transport
    thresholds: Thresholds
    duration_s: float | None = None
    recorder: Recorder | None = None
    clock: Clock = field(default_factory=SystemClock)
    progress: Callable[["Session"], None] = lambda session: None
    decoder: Decoder = field(default_factory=Decoder)
    validator: Validator = field(init=False)
    _source: Source | None = None
    _other_digest: str | None = None
    _heard: bytes = b""
    _status_text: str = ""

    def __post_init__(self) -> None:
        """Lower the design."""
        self.validator = Validator(self.design)

    def run(self) -> SessionResult:
        """Look at the device until time is up, the stream ends, or another design is met.

        Raises
        ------
        DeviceError
            If a live port stays without samples for 5 s, or goes away.
        """
        begun = self.clock.monotonic()
        last_sample = begun
        first_sample: float | None = None
        try:
            while self._other_digest is None:
                data = self.transport.read(POLL_S)
                now = self.clock.monotonic()
                if data is None:
                    self._require_end()
                    break
                if self._take(data):
                    last_sample = now
                    first_sample = now if first_sample is None else first_sample
                    self.progress(self)
                if self._time_is_up(first_sample, now):
                    break
                if self.transport.live and now - last_sample > SILENCE_S:
                    raise DeviceError(self._silence())
        except KeyboardInterrupt:
            if first_sample is None:
                raise
        ended = self.clock.monotonic()
        return SessionResult(
            report=self.validator.report(self.thresholds, other_digest=self._other_digest),
            thresholds=self.thresholds,
            link=self.decoder.statistics(),
            duration_s=ended - (begun if first_sample is None else first_sample),
        )

    def _time_is_up(self, first_sample: float | None, now: float) -> bool:
        if first_sample is None or self.duration_s is None:
            return False
        return now - first_sample >= self.duration_s

    def _take(self, data: bytes) -> bool:
        """Decode and judge some bytes; tell whether a sample was among them."""
        if self.validator.samples == 0:
            self._heard = (self._heard + data)[-512:]
        frames = self.decoder.feed(data)
        if self.recorder is not None:
            now_us = int(self.clock.time() * 1e6)
            for frame in frames:
                self.recorder.write(now_us, frame.raw)
        samples = [frame for frame in frames if self._is_ours(frame)]
        wanted = digest(self.design)
        for frame in samples:
            if digest_of(frame) != wanted:
                self._other_digest = digest_of(frame)
                return True
        hidden_words = len(self.validator.spec.hidden)
        self.validator.add(trace_of(samples, AXES[self.design.axes], hidden_words=hidden_words))
        return bool(samples)

    def _is_ours(self, frame: Frame) -> bool:
        """Tell whether a frame is a sample of the first device that sent one."""
        if frame.name == "STATUSTEXT":
            self._status_text = str(frame.message.text)[:50]
        if frame.name != "TILT_SAMPLE":
            return False
        if self._source is None:
            self._source = frame.source
        return frame.source == self._source

    def _require_end(self) -> None:
        if self.transport.live:
            raise DeviceError(
                f"the device went away after {self.validator.samples} samples; "
                "check its cable and power"
            )

    def _silence(self) -> str:
        """Say what was heard instead of samples."""
        if self.validator.samples:
            return f"the device stopped sending after {self.validator.samples} samples"
        if self.decoder.frames:
            said = f"; it says: {self._status_text!r}" if self._status_text else ""
            return (
                f"{self.decoder.frames} MAVLink messages came in {SILENCE_S:g} s, but no "
                f"TILT_SAMPLE{said}"
            )
        if not self._heard:
            return f"nothing was received in {SILENCE_S:g} s; is the device powered and wired?"
        printable = sum(32 <= byte < 127 or byte in b"\r\n\t" for byte in self._heard)
        if printable >= TEXT_SHARE * len(self._heard):
            return f"the port carries text, not MAVLink: {self._heard[-60:]!r}"
        return "bytes come that are not MAVLink 2; is the --baud rate that of the device?"
