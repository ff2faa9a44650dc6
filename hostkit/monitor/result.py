"""What a session found out."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from hostkit.link.statistics import LinkStatistics, TimingStatistics
from hostkit.monitor.snapshot import DeviceStatus, Notice, SessionInfo
from hostkit.records import ValidationReport, read_only
from hostkit.validation import Histogram, Thresholds

Vector = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Overlay:
    """A session thinned out to a bounded number of points, for a figure.

    Attributes
    ----------
    time_s
        Device time of the first sample of each point, counted from the first of the session;
        shape ``(N,)``.
    device_rad, model_rad
        Angles of that sample, shape ``(N, A)``.
    residual_rad
        The residual of the greatest size among the samples of the point, shape ``(N, A)``; NaN
        where none could be followed.
    begins
        True where a line is broken before the point, shape ``(N,)``.
    samples_per_point
        How many samples a point stands for.
    """

    time_s: Vector
    device_rad: Vector
    model_rad: Vector
    residual_rad: Vector
    begins: NDArray[np.bool_]
    samples_per_point: int

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for array in (self.time_s, self.device_rad, self.model_rad, self.residual_rad):
            read_only(array)
        read_only(self.begins)


@dataclass(frozen=True, slots=True, kw_only=True)
class SessionResult:
    """The verdict of a session, what it was judged by, and what the link did meanwhile.

    Attributes
    ----------
    duration_s
        From the first sample to the end.
    info
        What was judged; None where the session does not say.
    residual_histogram
        How the size of the residual is spread, rad, one for each axis of the design.
    jitter_histogram
        How far the time between two arrivals was from that between the samples, s.
    notices
        What happened, oldest first.
    """

    report: ValidationReport
    link: LinkStatistics
    duration_s: float
    thresholds: Thresholds = field(default_factory=Thresholds)
    timing: TimingStatistics = field(default_factory=TimingStatistics)
    info: SessionInfo | None = None
    device: DeviceStatus = field(default_factory=DeviceStatus)
    reconnects: int = 0
    overlay: Overlay | None = None
    residual_histogram: tuple[Histogram, ...] = ()
    jitter_histogram: Histogram | None = None
    notices: tuple[Notice, ...] = ()
