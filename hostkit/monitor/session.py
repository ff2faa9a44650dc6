"""A session: bytes from a port through decoder and models to views, recordings and a verdict."""

from collections.abc import Sequence
from concurrent.futures import Future, wait
from dataclasses import dataclass, field

from hostkit.errors import DeviceError
from hostkit.link.clock import Clock, SystemClock, epoch_us
from hostkit.link.frames.decoder import Frame
from hostkit.link.ports.transport import Transport
from hostkit.monitor.assembly import assemble
from hostkit.monitor.collect import JitterCollector, OverlayCollector
from hostkit.monitor.controls import SessionControls
from hostkit.monitor.inbox import Inbox
from hostkit.monitor.judge import Stretch
from hostkit.monitor.outlets import Outlets
from hostkit.monitor.parts import Parts, SessionOptions, session_info
from hostkit.monitor.receiver import Received, decoder_for
from hostkit.monitor.recording.recordings import Recorder
from hostkit.monitor.requests import SessionRequests
from hostkit.monitor.result import SessionResult
from hostkit.monitor.silence import SilenceWatch
from hostkit.monitor.snapshot import Controls, SessionInfo, Snapshot, View
from hostkit.records import FilterDesign
from hostkit.validation import Thresholds

POLL_S = 0.1
SNAPSHOT_EVERY_S = 0.25
RESULT_WAIT_S = 5.0


@dataclass(slots=True, kw_only=True)
class Session:
    """One device under validation; runs in the thread of the caller.

    Attributes
    ----------
    duration_s
        How long to look at samples, counted from the first; None until the stream ends.
    recorders
        Where every good frame goes; they are closed when the session ends.
    views
        What is shown samples as they come, and the state four times a second.
    outlets
        Where frames and samples go besides; closed by whoever opened them.
    controls
        What other threads may ask of it.
    """

    design: FilterDesign
    transport: Transport
    thresholds: Thresholds
    duration_s: float | None = None
    recorders: Sequence[Recorder] = ()
    clock: Clock = field(default_factory=SystemClock)
    options: SessionOptions = field(default_factory=SessionOptions)
    views: list[View] = field(default_factory=list)
    outlets: Outlets = field(default_factory=Outlets)
    controls: Controls = field(init=False)
    _parts: Parts = field(init=False)
    _silence: SilenceWatch = field(init=False)
    _overlay: OverlayCollector = field(init=False)
    _jitter: JitterCollector = field(init=False)
    _info: SessionInfo = field(init=False)
    _latest: Snapshot = field(init=False)
    _inbox: Inbox = field(default_factory=Inbox)
    _stopped: bool = False
    _stream_ended: bool = False
    _refusal_told: bool = False
    _begun_s: float = 0.0
    _next_snapshot_s: float = 0.0
    _final: SessionResult | None = None

    def __post_init__(self) -> None:
        """Put the parts together."""
        self._parts = parts = assemble(
            self.design,
            self.transport,
            self.thresholds,
            self.options,
            self.clock,
            recorders=self.recorders,
            outlets=self.outlets,
        )
        self._silence = SilenceWatch(
            self.transport,
            parts.receiver,
            parts.watches,
            parts.notices,
            self.clock,
            patient=self.options.patient,
        )
        self._collect_anew()
        self._info = session_info(self.design, self.transport, self.options.port, self.thresholds)
        self._begun_s = self.clock.monotonic()
        self._latest = parts.snapshot(elapsed_s=0.0, ended=False)
        self.controls = SessionControls(
            SessionRequests(parts, self._collect_anew),
            self._inbox,
            self._info,
            lambda: self._latest,
            parts.recordings.check,
        )

    def stop(self) -> None:
        """End the session soon; may be called from any thread and from a signal handler."""
        self._stopped = True

    @property
    def problems(self) -> tuple[str, ...]:
        """Why recordings ended early."""
        return tuple(self._parts.recordings.problems)

    def ask_result(self) -> SessionResult:
        """Return the result so far; called from another thread while the session runs.

        Raises
        ------
        DeviceError
            If the session does not answer.
        """
        answer: Future[SessionResult] = Future()
        if self._final is None:
            self._inbox.put(lambda: answer.set_result(self._result()))
            wait((answer,), RESULT_WAIT_S)
        if answer.done():
            return answer.result()
        if self._final is None:
            raise DeviceError(f"the session did not answer within {RESULT_WAIT_S:g} s")
        return self._final

    def run(self) -> SessionResult:
        """Look at the device until time is up, the stream ends, or another design is met.

        Raises
        ------
        DeviceError
            If a live port stays without samples for 5 s, or goes away.
        """
        self._begun_s = self.clock.monotonic()
        self._silence.begin()
        self._tell_earlier()
        try:
            while not self._is_over():
                self._turn()
        except KeyboardInterrupt:
            if self._silence.first_s is None:
                raise
        finally:
            self._parts.recordings.close()
            self._final = self._result()
            self._publish(ended=True)
        return self._final

    def _is_over(self) -> bool:
        if self._stopped:
            return True
        time_is_up = (
            self.duration_s is not None
            and self._silence.first_s is not None
            and self._elapsed_s() >= self.duration_s
        )
        at_end = self._stream_ended or self._parts.judge.refused
        return time_is_up or (at_end and not self.options.stays)

    def _turn(self) -> None:
        """Look at the port once, and show what came."""
        self._inbox.serve(POLL_S if self._stream_ended else 0.0)
        if not self._stream_ended or self.transport.state != "ended":
            self._stream_ended = False
            self._take(self._parts.receiver.receive(POLL_S))
            if self._stream_ended:
                self._publish()
        self._speak()
        if self.clock.monotonic() >= self._next_snapshot_s:
            self._publish()

    def _take(self, received: Received) -> None:
        """Give what came to everybody."""
        parts = self._parts
        if received.opened_anew:
            self._begin_epoch()
        if received.ended:
            self._end_of_stream()
        if received.lost_some:
            parts.validator.doubt_parameters()
        frames = received.frames
        parts.recordings.add(epoch_us(self.clock), frames)
        parts.outlets.send(frames)
        for frame in frames:
            parts.watches.take(frame)
            if frame.name == "TIMESYNC":
                parts.timesync.take(frame, frame.received_ns)
            elif frame.name not in ("TILT_SAMPLE", "ATTITUDE"):
                parts.conversation.take(frame)
        heard = self._judge(frames)
        self._silence.look(heard=heard, samples=parts.judge.samples)

    def _judge(self, frames: list[Frame]) -> bool:
        """Judge and show samples; tell whether there were any."""
        judge = self._parts.judge
        before = judge.samples
        for stretch in judge.take(frames, epoch_us(self.clock) * 1e-6, self._position_s):
            self._show(stretch)
        if judge.source is not None:
            self._parts.conversation.attend(judge.source)
            self._parts.timesync.source = judge.source
        if judge.refused and not self._refusal_told:
            self._parts.notices.add("error", judge.report(self.thresholds).reasons[0])
        self._refusal_told = judge.refused
        return judge.samples > before or judge.refused

    def _show(self, stretch: Stretch) -> None:
        if stretch.anew:
            self._forget_device()
        if self._parts.judge.epoch != self._latest.epoch:
            self._publish()
        self._parts.timesync.arrived(stretch.time_us, stretch.received_ns)
        self._jitter.arrived(stretch.time_us, stretch.received_ns)
        self._overlay.add(stretch.batch)
        self._parts.outlets.take_batch(stretch.batch)
        for view in self.views:
            view.take_batch(stretch.batch)

    def _begin_epoch(self) -> None:
        self._parts.judge.begin_epoch()
        self._tell_earlier()
        self._forget_device()

    def _forget_device(self) -> None:
        """Trust nothing that holds only while a device runs on: its clock, what it was asked."""
        self._parts.conversation.begin_epoch()
        self._parts.timesync.begin_epoch()
        self._jitter.begin_epoch()

    def _tell_earlier(self) -> None:
        """Tell the models which parameters held where a replay begins."""
        replay = self._parts.replay
        if replay is not None:
            told = b"".join(replay.parameters_before())
            self._parts.judge.tell(decoder_for(replay, self.options.signing).feed(told))

    def _speak(self) -> None:
        """Send what is due to the device."""
        conversation = self._parts.conversation
        for raw in self._parts.outlets.receive():
            conversation.pass_on(raw)
        conversation.learn(self._parts.validator.untold)
        conversation.learn_state(self._parts.validator.needs_state)
        conversation.poll()
        if self.transport.live and self._parts.judge.source is not None:
            request = self._parts.timesync.poll()
            if request is not None:
                conversation.send(request)

    def _end_of_stream(self) -> None:
        self._stream_ended = True
        if self.transport.live:
            raise DeviceError(
                f"the device went away after {self._parts.judge.samples} samples; "
                "check its cable and power"
            )

    def _position_s(self) -> float:
        """Return where on the time axis a new epoch begins."""
        if self._parts.replay is not None:
            return self._parts.replay.chunk_begin_s
        known = self.transport.live and self._silence.first_s is not None
        return self._elapsed_s() if known else 0.0

    def _elapsed_s(self) -> float:
        first_s = self._silence.first_s
        return self.clock.monotonic() - (self._begun_s if first_s is None else first_s)

    def _collect_anew(self) -> None:
        self._overlay = OverlayCollector(len(self._parts.validator.spec.axes))
        self._jitter = JitterCollector()

    def _result(self) -> SessionResult:
        parts = self._parts
        return SessionResult(
            report=parts.judge.report(self.thresholds),
            link=parts.receiver.statistics(),
            duration_s=self._elapsed_s(),
            thresholds=self.thresholds,
            timing=parts.timesync.statistics(),
            info=self._info,
            device=parts.watches.status(parts.judge.source),
            reconnects=parts.receiver.reconnects,
            overlay=self._overlay.overlay(),
            residual_histogram=self._parts.validator.histograms(),
            jitter_histogram=self._jitter.histogram(),
            notices=parts.notices.latest(),
        )

    def _publish(self, *, ended: bool = False) -> None:
        self._next_snapshot_s = self.clock.monotonic() + SNAPSHOT_EVERY_S
        self._latest = self._parts.snapshot(elapsed_s=self._elapsed_s(), ended=ended)
        for view in self.views:
            view.take_snapshot(self._latest)
