"""A session: bytes from a port through decoder and models to views, recordings and a verdict."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from hostkit import __version__
from hostkit.design_file import digest
from hostkit.errors import DeviceError, HostkitError
from hostkit.filters.complementary import crossover_hz, tau_from_eta
from hostkit.link.clock import Clock, SystemClock
from hostkit.link.decoder import Decoder
from hostkit.link.statistics import LinkStatistics, TimingStatistics
from hostkit.link.tlog import TlogWriter
from hostkit.link.transport import Transport
from hostkit.monitor.controls import SessionControls
from hostkit.monitor.device_status import Watches
from hostkit.monitor.inbox import Inbox
from hostkit.monitor.judge import Judge
from hostkit.monitor.notices import Notices
from hostkit.monitor.rates import Rates, Totals
from hostkit.monitor.receiver import Received, Receiver
from hostkit.monitor.recordings import Recorder, Recordings
from hostkit.monitor.snapshot import (
    Controls,
    ParameterState,
    SessionInfo,
    Snapshot,
    View,
)
from hostkit.records import AXES, FilterDesign, ValidationReport
from hostkit.validation import Thresholds, Validator

POLL_S = 0.1
SILENCE_S = 5.0
"""How long a live port may stay without a sample before the session gives up."""

SNAPSHOT_EVERY_S = 0.25


@dataclass(frozen=True, slots=True, kw_only=True)
class SessionResult:
    """The verdict of a session, and what the link did meanwhile."""

    report: ValidationReport
    link: LinkStatistics
    duration_s: float


@dataclass(frozen=True, slots=True, kw_only=True)
class SessionOptions:
    """What a session may do beside judging.

    Attributes
    ----------
    port
        Name of the port, to be shown.
    system
        Id of the system to follow; None follows the first that sends samples.
    patient
        Whether to wait for a device that has been heard once and went silent.
    stays
        Whether to go on after a refusal or the end of a file, until told to stop.
    folder
        Where recordings that are asked for while it runs go.
    """

    port: str = ""
    system: int | None = None
    patient: bool = False
    stays: bool = False
    folder: Path = Path()


@dataclass(slots=True, kw_only=True)
class Session:
    """One device under validation; runs in the thread of the caller.

    Attributes
    ----------
    duration_s
        How long to look at samples, counted from the first; None until the stream ends.
    recorder
        Where every good frame goes.
    views
        What is shown samples as they come, and the state four times a second.
    controls
        What other threads may ask of it.
    """

    design: FilterDesign
    transport: Transport
    thresholds: Thresholds
    duration_s: float | None = None
    recorder: Recorder | None = None
    clock: Clock = field(default_factory=SystemClock)
    options: SessionOptions = field(default_factory=SessionOptions)
    views: list[View] = field(default_factory=list)
    open_recorder: Callable[[Path], Recorder] = TlogWriter
    controls: Controls = field(init=False)
    _notices: Notices = field(init=False)
    _receiver: Receiver = field(init=False)
    _judge: Judge = field(init=False)
    _recordings: Recordings = field(init=False)
    _latest: Snapshot = field(init=False)
    _inbox: Inbox = field(default_factory=Inbox)
    _watches: Watches = field(default_factory=Watches)
    _rates: Rates = field(default_factory=Rates)
    _stopped: bool = False
    _ended: bool = False
    _begun_s: float = 0.0
    _first_sample_s: float | None = None
    _last_sample_s: float = 0.0
    _next_snapshot_s: float = 0.0
    _silent: bool = False

    def __post_init__(self) -> None:
        """Put the parts together."""
        self._notices = Notices(self.clock)
        self._receiver = Receiver(self.transport, Decoder(), self.clock, self._notices)
        validator = Validator(self.design)
        self._judge = Judge(self.design, validator, self._notices, self.options.system)
        self._recordings = Recordings(
            () if self.recorder is None else (self.recorder,),
            self.options.folder,
            self.open_recorder,
            self._notices,
        )
        self._begun_s = self.clock.monotonic()
        self._latest = self._snapshot()
        self.controls = SessionControls(
            self, self._inbox, self._info(), lambda: self._latest, self._recordings.check
        )

    def stop(self) -> None:
        """End the session soon; may be called from any thread and from a signal handler."""
        self._stopped = True

    @property
    def problems(self) -> tuple[str, ...]:
        """Why recordings ended early."""
        return tuple(self._recordings.problems)

    def run(self) -> SessionResult:
        """Look at the device until time is up, the stream ends, or another design is met.

        Raises
        ------
        DeviceError
            If a live port stays without samples for 5 s, or goes away.
        """
        self._begun_s = self._last_sample_s = self.clock.monotonic()
        try:
            while not self._is_over():
                self._turn()
        except KeyboardInterrupt:
            if self._first_sample_s is None:
                raise
        finally:
            self._recordings.close()
        result = self._result()
        self._publish(ended=True)
        return result

    def _is_over(self) -> bool:
        if self._stopped:
            return True
        first_s = self._first_sample_s
        watched = first_s is not None and self.duration_s is not None
        if watched and self.clock.monotonic() - first_s >= self.duration_s:
            return True
        return not self.options.stays and (self._ended or self._judge.refused)

    def _turn(self) -> None:
        """Look at the port once, and show what came."""
        self._inbox.serve(POLL_S if self._ended else 0.0)
        if not self._ended:
            self._take(self._receiver.receive(POLL_S))
        if self.clock.monotonic() >= self._next_snapshot_s:
            self._publish()

    def _take(self, received: Received) -> None:
        if received.opened_anew:
            self._judge.begin_epoch()
        if received.ended:
            self._end_of_stream()
        frames = received.frames
        self._recordings.add(int(self.clock.time() * 1e6), frames)
        for frame in frames:
            self._watches.take(frame)
        before = self._judge.samples
        shown_epoch = self._judge.epoch
        for batch in self._judge.take(frames, self.clock.time(), self._position_s()):
            if self._judge.epoch != shown_epoch:
                shown_epoch = self._judge.epoch
                self._publish()
            for view in self.views:
                view.take_batch(batch)
        self._follow_silence(self._judge.samples > before)

    def _end_of_stream(self) -> None:
        self._ended = True
        if self.transport.live:
            raise DeviceError(
                f"the device went away after {self._judge.samples} samples; "
                "check its cable and power"
            )

    def _follow_silence(self, heard: bool) -> None:
        """Give up after 5 s without samples, or wait on if that was asked for."""
        now = self.clock.monotonic()
        if heard or self._judge.refused:
            if self._silent:
                gap_s = now - self._last_sample_s
                self._notices.add("info", f"samples come again after {gap_s:.1f} s")
            self._last_sample_s, self._silent = now, False
            if self._first_sample_s is None:
                self._first_sample_s = now
        elif self.transport.live and now - self._last_sample_s > SILENCE_S and not self._silent:
            if not self.options.patient or self._first_sample_s is None:
                raise DeviceError(self._explain_silence())
            self._silent = True
            self._notices.add("warning", self._explain_silence())

    def _explain_silence(self) -> str:
        """Say what was heard instead of samples."""
        if self._judge.samples:
            return f"the device stopped sending after {self._judge.samples} samples"
        frames = self._receiver.statistics().frames
        if not frames:
            return self._receiver.explain_noise(SILENCE_S)
        text = self._watches.last_text
        said = f"; it says: {text!r}" if text else ""
        return f"{frames} MAVLink messages came in {SILENCE_S:g} s, but no TILT_SAMPLE{said}"

    def _position_s(self) -> float:
        """Return where on the time axis a new epoch begins."""
        return self._elapsed_s() if self.transport.live else 0.0

    def _elapsed_s(self) -> float:
        begun_s = self._begun_s if self._first_sample_s is None else self._first_sample_s
        return self.clock.monotonic() - begun_s

    def _result(self) -> SessionResult:
        return SessionResult(
            report=self._report(), link=self._receiver.statistics(), duration_s=self._elapsed_s()
        )

    def _report(self) -> ValidationReport:
        judge = self._judge
        return judge.validator.report(
            self.thresholds, other_digest=judge.other_digest, retuned=judge.retuned
        )

    def _publish(self, *, ended: bool = False) -> None:
        self._next_snapshot_s = self.clock.monotonic() + SNAPSHOT_EVERY_S
        self._latest = self._snapshot(ended=ended)
        for view in self.views:
            view.take_snapshot(self._latest)

    def _snapshot(self, *, ended: bool = False) -> Snapshot:
        link = self._receiver.statistics()
        now_s = self.clock.monotonic()
        rates = self._rates.mark(
            Totals(
                time_s=now_s,
                frames=link.frames,
                received_bytes=link.received_bytes,
                samples=self._judge.samples,
            )
        )
        return Snapshot(
            time_s=self.clock.time(),
            elapsed_s=self._elapsed_s(),
            epoch=self._judge.epoch,
            port_state=self.transport.state,
            reconnects=self._receiver.reconnects,
            frames_per_s=rates.frames,
            bytes_per_s=rates.received_bytes,
            samples_per_s=rates.samples,
            link=link,
            timing=TimingStatistics(),
            device=self._watches.status(self._judge.source),
            report=self._report(),
            parameters=self._parameters(),
            command=None,
            recording=self._recordings.state(),
            replay=None,
            forwards=(),
            notices=self._notices.latest(),
            ended=ended or self._ended or (self._judge.refused and not self.options.stays),
        )

    def _parameters(self) -> tuple[ParameterState, ...]:
        return ()

    def _info(self) -> SessionInfo:
        eta = self.design.parameter("eta")
        tau_s = tau_from_eta(eta, self.design.period_s)
        return SessionInfo(
            design_digest=digest(self.design),
            axes=AXES[self.design.axes],
            rate_hz=self.design.rate_hz,
            eta=eta,
            tau_s=tau_s,
            crossover_hz=crossover_hz(eta, self.design.period_s),
            port=self.options.port,
            replay=not self.transport.live,
            hostkit_version=__version__,
        )

    def on_parameter(self, name: str, value: float) -> None:
        """Ask the device to use a value."""
        raise HostkitError(f"{name} = {value:g} cannot be set")

    def on_revert(self) -> None:
        """Ask the device for the design's values."""

    def on_command(self, name: str) -> None:
        """Send a command."""

    def on_start_recording(self, name: str) -> None:
        """Begin a file."""
        self._recordings.start(name)

    def on_stop_recording(self) -> None:
        """Finish it."""
        self._recordings.stop()

    def on_port(self, take: bool) -> None:
        """Release the port or take it again."""

    def on_restart(self) -> None:
        """Judge anew."""

    def on_pause(self, paused: bool) -> None:
        """Hold the replay."""

    def on_seek(self, position_s: float) -> None:
        """Replay from elsewhere."""

    def on_speed(self, speed: float | None) -> None:
        """Replay at another speed."""
