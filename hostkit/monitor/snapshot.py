"""What a session shows of itself: samples as they come, and its whole state a few times a second.

A view only reads these records, whether it is a page, a terminal or a test.
"""

from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from hostkit.filters.filter import Fact, ParameterView
from hostkit.link.ports.transport import PortState
from hostkit.link.statistics import LinkStatistics, TimingStatistics
from hostkit.records import Axis, ValidationReport, read_only

Vector = NDArray[np.float64]
Level = Literal["info", "warning", "error"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Batch:
    """Samples that came together, beside their models.

    Attributes
    ----------
    time_s
        Device time, counted from the first sample of the session, shape ``(N,)``.
    received_s
        Host time of arrival of the batch, seconds since 1970.
    device_rad, model_rad, residual_rad
        Angles of the device, of the float model, and the wrap-safe difference, shape ``(N, A)``;
        model and residual are NaN where the step could not be followed.
    mismatch
        True where the integer model says another thing, shape ``(N,)``.
    begins
        True where a sample does not follow the one before it: a line is broken there. Shape
        ``(N,)``.
    epoch
        The epoch its samples belong to, as in `Snapshot`.
    """

    time_s: Vector
    received_s: float
    device_rad: Vector
    model_rad: Vector
    residual_rad: Vector
    mismatch: NDArray[np.bool_]
    begins: NDArray[np.bool_]
    epoch: int = 0

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for array in (self.time_s, self.device_rad, self.model_rad, self.residual_rad):
            read_only(array)
        read_only(self.mismatch)
        read_only(self.begins)

    def __len__(self) -> int:
        return len(self.time_s)


@dataclass(frozen=True, slots=True, kw_only=True)
class SessionInfo:
    """What does not change while a session runs.

    Attributes
    ----------
    filter
        The filter of the design, as a person calls it.
    facts
        What people want to read of the design.
    max_rms_deg, max_abs_deg
        What the residual is allowed; None is no limit.
    """

    design_digest: str
    axes: tuple[Axis, ...]
    rate_hz: float
    filter: str
    facts: tuple[Fact, ...]
    port: str
    replay: bool
    hostkit_version: str
    max_rms_deg: float | None = None
    max_abs_deg: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class DeviceStatus:
    """What the device says of itself; None where it has not said it yet."""

    system: int | None = None
    component: int | None = None
    state: str | None = None
    """MAV_STATE without its prefix: BOOT, CALIBRATING, ACTIVE, CRITICAL ..."""
    version: str | None = None
    uptime_s: float | None = None
    temperature_deg_c: float | None = None
    load_percent: float | None = None
    healthy: bool | None = None
    bus_errors: int | None = None
    texts: tuple[str, ...] = ()
    """The latest status texts, newest last, at most 20."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ParameterState:
    """One parameter of the device.

    Attributes
    ----------
    value
        What the device last told to be in use.
    design_value
        What it tells when nothing was set on it; None for a parameter that is not of the filter.
    wanted
        What was asked for and is not answered yet.
    error
        Why the last setting did not take; empty if it did.
    symbol, title, views
        As in :class:`hostkit.filters.filter.KnownParameter`, for the rate of the design.
    """

    name: str
    value: float
    unit: str
    design_value: float | None = None
    lowest: float | None = None
    highest: float | None = None
    wanted: float | None = None
    error: str = ""
    symbol: str = ""
    title: str = ""
    views: tuple[ParameterView, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class CommandState:
    """The last command to the device, such as ``calibrate``, and what it answered."""

    name: str
    state: Literal["waiting", "in progress", "accepted", "refused", "no answer"]
    detail: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordingState:
    """A recording that is being written, or the last one that was."""

    name: str
    active: bool
    frames: int
    written_bytes: int
    error: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class ReplayState:
    """Where a replay stands. `speed` is None when it runs as fast as it can."""

    position_s: float
    length_s: float
    speed: float | None
    paused: bool
    ended: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class ForwardState:
    """One place that frames are forwarded to, and what went there and back."""

    address: str
    sent_frames: int
    dropped_frames: int
    received_frames: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Notice:
    """Something that happened, with its time in seconds since 1970."""

    time_s: float
    level: Level
    text: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Snapshot:
    """The state of a session at one moment.

    Attributes
    ----------
    epoch
        Rises whenever device time begins anew: on a restart, a reconnection, a seek. What was
        drawn before belongs to another epoch.
    missed_batches
        Batches that slow views did not take.
    ended
        Whether the session is over; `report` is then final.
    """

    time_s: float
    elapsed_s: float
    epoch: int
    port_state: PortState
    reconnects: int
    frames_per_s: float
    bytes_per_s: float
    samples_per_s: float
    link: LinkStatistics
    timing: TimingStatistics
    device: DeviceStatus
    report: ValidationReport
    parameters: tuple[ParameterState, ...]
    command: CommandState | None
    recording: RecordingState | None
    replay: ReplayState | None
    forwards: tuple[ForwardState, ...]
    notices: tuple[Notice, ...]
    """The latest, newest last, at most 50."""
    missed_batches: int = 0
    ended: bool = False


class View(Protocol):
    """Takes what a session shows. Called from the session's thread; must not block it."""

    def take_batch(self, batch: Batch) -> None:
        """Take samples."""

    def take_snapshot(self, snapshot: Snapshot) -> None:
        """Take the state."""


class Controls(Protocol):
    """What a view may ask of a session, from any thread; nothing here waits.

    What becomes of it shows in the snapshots. A request that makes no sense, such as a name that
    is no parameter or a seek in a live session, raises HostkitError at once.
    """

    def info(self) -> SessionInfo:
        """Return what does not change."""

    def snapshot(self) -> Snapshot:
        """Return the latest state."""

    def set_parameter(self, name: str, value: float) -> None:
        """Ask the device to use a value."""

    def revert_parameters(self) -> None:
        """Ask the device to use the values of its design."""

    def command(self, name: str) -> None:
        """Send ``calibrate``, ``self-test``, ``store``, ``reboot``."""

    def start_recording(self, name: str) -> None:
        """Write what comes to a new file of the session's folder; the suffix says its form."""

    def stop_recording(self) -> None:
        """Finish the file."""

    def release_port(self) -> None:
        """Close the port, so that another program can have it."""

    def take_port(self) -> None:
        """Open the port again."""

    def restart_verdict(self) -> None:
        """Forget the figures so far and judge anew from here."""

    def pause(self, paused: bool) -> None:
        """Hold a replay, or let it go on."""

    def seek(self, position_s: float) -> None:
        """Go on with a replay elsewhere."""

    def set_speed(self, speed: float | None) -> None:
        """Replay so many times as fast as it was; None is as fast as possible."""
