"""Keeping what a device sends without judging it."""

from collections.abc import Sequence
from dataclasses import dataclass

from hostkit.errors import DeviceError
from hostkit.link.clock import Clock, SystemClock, epoch_us
from hostkit.link.frames.signing import SigningKey
from hostkit.link.ports.transport import Transport
from hostkit.link.statistics import LinkStatistics
from hostkit.monitor.device_status import Watches
from hostkit.monitor.notices import Notices
from hostkit.monitor.receiver import Receiver, decoder_for
from hostkit.monitor.recording.recordings import Recorder, Recordings
from hostkit.monitor.silence import SilenceWatch
from hostkit.monitor.snapshot import DeviceStatus, Notice

POLL_S = 0.1


@dataclass(frozen=True, slots=True, kw_only=True)
class CaptureResult:
    """What came while a device was recorded.

    Attributes
    ----------
    problems
        Why files ended early.
    """

    link: LinkStatistics
    duration_s: float
    samples: int
    reconnects: int
    device: DeviceStatus
    notices: tuple[Notice, ...]
    problems: tuple[str, ...]


class Capture:
    """Receives from a port and writes to files; sends nothing.

    Parameters
    ----------
    duration_s
        How long, counted from the first frame; None until the stream ends.
    patient
        Whether to wait for a device that has been heard once and went silent.
    """

    def __init__(
        self,
        transport: Transport,
        recorders: Sequence[Recorder],
        *,
        duration_s: float | None = None,
        patient: bool = False,
        signing: SigningKey | None = None,
        clock: Clock | None = None,
    ) -> None:
        self._transport, self._recorders = transport, tuple(recorders)
        self._duration_s = duration_s
        self._clock = clock or SystemClock()
        self._notices = Notices(self._clock)
        decoder = decoder_for(transport, signing)
        self._receiver = Receiver(transport, decoder, self._clock, self._notices)
        self._recordings = Recordings(self._recorders, self._notices)
        self._watches = Watches()
        self._silence = SilenceWatch(
            transport, self._receiver, self._watches, self._notices, self._clock, patient=patient
        )
        self._samples = 0
        self._stopped = self._ended = False

    def stop(self) -> None:
        """End soon; may be called from any thread and from a signal handler."""
        self._stopped = True

    def run(self) -> CaptureResult:
        """Record until time is up or the stream ends.

        Raises
        ------
        DeviceError
            If a live port stays silent for 5 s, or goes away.
        """
        begun_s = self._clock.monotonic()
        self._silence.begin()
        try:
            while not self._is_over():
                self._turn()
        finally:
            self._recordings.close()
        first_s = self._silence.first_s
        return CaptureResult(
            link=self._receiver.statistics(),
            duration_s=self._clock.monotonic() - (begun_s if first_s is None else first_s),
            samples=self._samples,
            reconnects=self._receiver.reconnects,
            device=self._watches.status(None),
            notices=self._notices.latest(),
            problems=tuple(self._recordings.problems),
        )

    def _is_over(self) -> bool:
        first_s = self._silence.first_s
        if self._stopped or self._ended or not self._recordings.active:
            return True
        if first_s is None or self._duration_s is None:
            return False
        return self._clock.monotonic() - first_s >= self._duration_s

    def _turn(self) -> None:
        received = self._receiver.receive(POLL_S)
        self._recordings.add(epoch_us(self._clock), received.frames)
        for frame in received.frames:
            self._watches.take(frame)
            self._samples += frame.name == "TILT_SAMPLE" and not frame.repeated
        self._silence.look(heard=bool(received.frames), samples=self._samples)
        if received.ended:
            self._ended = True
            if self._transport.live:
                frames = self._receiver.statistics().frames
                raise DeviceError(
                    f"the device went away after {frames} messages; check its cable and power"
                )
