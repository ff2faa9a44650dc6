"""What a link delivered, what it lost, and how late it was."""

from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True, kw_only=True)
class SourceStatistics:
    """The frames of one sender.

    Attributes
    ----------
    frames
        Frames that arrived whole, each once.
    lost
        Frames that never arrived, by the gaps in the sender's 8-bit counter.
    duplicated
        Frames that arrived again.
    reordered
        Frames that arrived behind a later one; they are not among the lost.
    restarts
        How often the counter began anew because the sender did.
    """

    system: int
    component: int
    frames: int = 0
    lost: int = 0
    duplicated: int = 0
    reordered: int = 0
    restarts: int = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class LinkStatistics:
    """What a link delivered and what it lost, all senders together.

    Attributes
    ----------
    received_bytes
        Everything that came, frames and noise.
    frames, lost_frames, duplicated, reordered
        Sums over `sources`.
    bad, bad_bytes
        Pieces of the stream that were no intact frame, and their bytes.
    crc_failures
        Those of the bad pieces that looked like a frame but failed its checksum.
    bad_signatures
        Frames that were refused because of their signature, or for want of one.
    unknown
        Frames of an id that the dialect does not have; their checksum cannot be checked.
    resyncs
        How often the stream was found again after something bad.
    overrun_bytes
        Bytes that came while the queue of received bytes was full, and were dropped.
    """

    received_bytes: int = 0
    frames: int = 0
    lost_frames: int = 0
    duplicated: int = 0
    reordered: int = 0
    bad: int = 0
    bad_bytes: int = 0
    crc_failures: int = 0
    bad_signatures: int = 0
    unknown: int = 0
    resyncs: int = 0
    overrun_bytes: int = 0
    sources: tuple[SourceStatistics, ...] = field(default=())


@dataclass(frozen=True, slots=True, kw_only=True)
class Spread:
    """Median, 95th percentile and maximum of a quantity, in milliseconds."""

    median_ms: float
    p95_ms: float
    max_ms: float


@dataclass(frozen=True, slots=True, kw_only=True)
class TimingStatistics:
    """How late samples come, and how evenly.

    Attributes
    ----------
    round_trip_ms
        Shortest round trip of TIMESYNC; None while none was answered.
    clock_ppm
        How much faster the device's clock runs than the host's, parts per million; None while
        too little time has passed to tell.
    latency
        From a sample's time on the device to its arrival here; None without TIMESYNC.
    jitter
        How far the time between two arrivals is from the time between the samples.
    """

    round_trip_ms: float | None = None
    clock_ppm: float | None = None
    latency: Spread | None = None
    jitter: Spread | None = None
