"""What a session is put together from, and the state of all of it at one moment."""

from dataclasses import dataclass, field
from pathlib import Path

from hostkit import __version__
from hostkit.design_file import digest
from hostkit.filters import FILTERS
from hostkit.link.clock import Clock
from hostkit.link.frames.signing import SigningKey
from hostkit.link.frames.timesync import TimeSync
from hostkit.link.logs.replay import ReplayTransport
from hostkit.link.ports.transport import Transport
from hostkit.monitor.conversation import Conversation
from hostkit.monitor.device_status import Watches
from hostkit.monitor.judge import Judge
from hostkit.monitor.notices import Notices
from hostkit.monitor.outlets import Outlets
from hostkit.monitor.rates import Rates, Totals
from hostkit.monitor.receiver import Receiver
from hostkit.monitor.recording.recordings import Recordings
from hostkit.monitor.snapshot import ReplayState, SessionInfo, Snapshot
from hostkit.records import AXES, FilterDesign
from hostkit.validation import Thresholds, Validator


@dataclass(frozen=True, slots=True, kw_only=True)
class SessionOptions:
    """What a session may do beside judging.

    Attributes
    ----------
    port
        Name of the port, to be shown.
    system
        Id of the system to follow; None follows the first that sends samples.
    tolerance_rad
        How far a filter in float may be from the float model; None for one in integers.
    as_designed
        Whether a device with other parameters than those of its design is refused.
    passive
        Whether nothing is sent to the device.
    patient
        Whether to wait for a device that has been heard once and went silent.
    stays
        Whether to go on after a refusal or the end of a file, until told to stop.
    folder
        Where recordings that are asked for while it runs go.
    signing
        Key that the device knows, too.
    """

    port: str = ""
    system: int | None = None
    tolerance_rad: float | None = None
    as_designed: bool = False
    passive: bool = False
    patient: bool = False
    stays: bool = False
    folder: Path = Path()
    signing: SigningKey | None = None


@dataclass(slots=True, kw_only=True)
class Parts:
    """The parts of a running session."""

    thresholds: Thresholds
    transport: Transport
    clock: Clock
    notices: Notices
    receiver: Receiver
    validator: Validator
    judge: Judge
    conversation: Conversation
    timesync: TimeSync
    recordings: Recordings
    outlets: Outlets
    watches: Watches = field(default_factory=Watches)
    rates: Rates = field(default_factory=Rates)

    @property
    def replay(self) -> ReplayTransport | None:
        """The transport, if it is a replay that can be paused and moved."""
        return self.transport if isinstance(self.transport, ReplayTransport) else None

    def snapshot(self, *, elapsed_s: float, ended: bool) -> Snapshot:
        """Return the state of everything."""
        link = self.receiver.statistics()
        rates = self.rates.mark(
            Totals(
                time_s=self.clock.monotonic(),
                frames=link.frames,
                received_bytes=link.received_bytes,
                samples=self.judge.samples,
            )
        )
        return Snapshot(
            time_s=self.clock.time(),
            elapsed_s=elapsed_s,
            epoch=self.judge.epoch,
            port_state=self.transport.state,
            reconnects=self.receiver.reconnects,
            frames_per_s=rates.frames,
            bytes_per_s=rates.received_bytes,
            samples_per_s=rates.samples,
            link=link,
            timing=self.timesync.statistics(),
            device=self.watches.status(self.judge.source),
            report=self.judge.report(self.thresholds),
            parameters=self.conversation.parameters(),
            command=self.conversation.command_state(),
            recording=self.recordings.state(),
            replay=_replay_state(self.replay),
            forwards=self.outlets.states(),
            notices=self.notices.latest(),
            ended=ended,
        )


def _replay_state(replay: ReplayTransport | None) -> ReplayState | None:
    if replay is None:
        return None
    return ReplayState(
        position_s=replay.position_s,
        length_s=replay.length_s,
        speed=replay.speed,
        paused=replay.paused,
        ended=replay.state == "ended",
    )


def session_info(
    design: FilterDesign, transport: Transport, port: str, thresholds: Thresholds
) -> SessionInfo:
    """Return what does not change while a session runs."""
    filter_ = FILTERS[design.filter]
    return SessionInfo(
        design_digest=digest(design),
        axes=AXES[design.axes],
        rate_hz=design.rate_hz,
        filter=filter_.title,
        facts=filter_.facts(design),
        port=port,
        replay=not transport.live,
        hostkit_version=__version__,
        max_rms_deg=thresholds.max_rms_deg,
        max_abs_deg=thresholds.max_abs_deg,
    )
