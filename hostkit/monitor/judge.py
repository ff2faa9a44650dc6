"""Picking the samples of one device out of a stream and holding them against the models."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.design_file import digest
from hostkit.link.frames.decoder import Frame, Source, digest_of, trace_of
from hostkit.link.frames.samples import SAMPLE, STATE, payloads
from hostkit.monitor.device_status import US_PER_S
from hostkit.monitor.notices import Notices
from hostkit.monitor.snapshot import Batch
from hostkit.records import AXES, FilterDesign, ValidationReport
from hostkit.validation import Judged, Thresholds, Validator

MOST_OTHERS = 8
"""Other devices that are told of; a hostile stream may claim any number."""

PARAMETER = "PARAM_VALUE"
MOST_STATES = 64
"""States that are kept until a sample comes; the device tells one now and then."""

MOST_EARLIER = 256
"""Parameters that are kept until it is known whose they are."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Stretch:
    """Judged samples whose device time rises.

    Attributes
    ----------
    time_us, received_ns
        Device time, and host time of arrival, shape ``(N,)``.
    anew
        Whether the device itself began anew with them.
    """

    batch: Batch
    time_us: NDArray[np.int64]
    received_ns: NDArray[np.int64]
    anew: bool


class Judge:
    """Follows the first device that sends samples, or the one of a given system.

    Parameters
    ----------
    as_designed
        Whether a device with other parameters than those of its design is refused.

    Attributes
    ----------
    source
        Whose samples are judged; None until one came.
    other_digest
        Digest of the design that the device runs, if it is another one.
    epoch
        Rises whenever device time begins anew.
    """

    def __init__(
        self,
        design: FilterDesign,
        validator: Validator,
        notices: Notices,
        *,
        system: int | None = None,
        as_designed: bool = False,
    ) -> None:
        self._axes = AXES[design.axes]
        self._validator, self._notices = validator, notices
        self._system, self._as_designed = system, as_designed
        self._digest = np.frombuffer(bytes.fromhex(digest(design)), dtype=np.uint8)
        self._period_s = design.period_s
        self._others: set[Source] = set()
        self._earlier: list[Frame] = []
        self._states: list[Frame] = []
        self._newest_us: int | None = None
        self._newest_s = 0.0
        self._is_retuned = False
        self.source: Source | None = None
        self.other_digest: str | None = None
        self.epoch = 0
        self.samples = 0

    @property
    def refused(self) -> bool:
        """Whether the device cannot be judged."""
        return self.other_digest is not None or (self._as_designed and self._is_retuned)

    def report(self, thresholds: Thresholds) -> ValidationReport:
        """Give the verdict so far."""
        return self._validator.report(thresholds, other_digest=self.other_digest)

    def begin_epoch(self) -> None:
        """Take the next sample for the first: the port was opened anew, or the replay moved."""
        self.epoch += 1
        self._newest_us, self._states = None, []
        self.other_digest, self._is_retuned = None, False
        self._validator.begin_epoch()

    def restart(self) -> None:
        """Forget the figures so far."""
        self._validator.restart()
        self.other_digest, self._is_retuned = None, False

    def tell(self, frames: list[Frame]) -> None:
        """Take parameters that devices told earlier; they count once it is known which is ours."""
        self._earlier = [frame for frame in frames if frame.name == PARAMETER]
        if self.source is not None:
            self._take_earlier()

    def _take_earlier(self) -> None:
        for frame in self._earlier:
            if frame.source == self.source:
                self._told(frame)
        self._earlier = []

    def take(
        self, frames: list[Frame], epoch_s: float, position_s: Callable[[], float]
    ) -> Iterator[Stretch]:
        """Judge the samples among some frames.

        Parameters
        ----------
        epoch_s
            The time since 1970, s, at which the clock of the frames' arrivals was 0.
        position_s
            Where the time axis stands, s: what comes first in a new epoch is shown there.
        """
        run, self._states = self._states, []
        for frame in frames:
            if self._is_ours(frame) or self._is_our_state(frame):
                run.append(frame)
            elif frame.name != PARAMETER or frame.repeated:
                continue
            elif frame.source == self.source:
                yield from self._judge(run, epoch_s, position_s)
                run, self._states = self._states, []
                self._told(frame)
            elif self.source is None and len(self._earlier) < MOST_EARLIER:
                self._earlier.append(frame)
        yield from self._judge(run, epoch_s, position_s)

    def _judge(
        self, run: list[Frame], epoch_s: float, position_s: Callable[[], float]
    ) -> Iterator[Stretch]:
        samples = [frame for frame in run if frame.name == SAMPLE]
        if not samples or self.refused:
            self._states = [] if self.refused else run[:MOST_STATES]
            return
        others = np.flatnonzero((payloads(samples)["digest"] != self._digest).any(axis=1))
        if len(others):
            self.other_digest = digest_of(samples[others[0]])
            run = run[: run.index(samples[others[0]])]
            samples = samples[: others[0]]
        hidden_words = len(self._validator.spec.hidden)
        trace = trace_of(run, self._axes, hidden_words=hidden_words)
        self._is_retuned |= trace.retuned is not None and bool(trace.retuned.any())
        self.samples += len(samples)
        if self._as_designed and self._is_retuned:
            self._validator.add(trace)
            return
        came_ns = {t: f.received_ns for t, f in zip(trace.time_us.tolist(), samples, strict=True)}
        judged = self._validator.add(trace)
        for part in _rising(judged.time_us):
            received_ns = np.array([came_ns[t] for t in judged.time_us[part].tolist()])
            yield self._stretch(judged, part, received_ns, epoch_s, position_s)

    def _stretch(
        self,
        judged: Judged,
        part: slice,
        received_ns: NDArray[np.int64],
        epoch_s: float,
        position_s: Callable[[], float],
    ) -> Stretch:
        time_us = judged.time_us[part]
        first_us = int(time_us[0])
        anew = self._newest_us is not None and first_us < self._newest_us
        if self._newest_us is None:
            begin_s = position_s()
        elif anew:
            self.epoch += 1
            self._notices.add("warning", "the device has started anew")
            begin_s = max(position_s(), self._newest_s + self._period_s)
        else:
            begin_s = self._newest_s + (first_us - self._newest_us) / US_PER_S
        time_s = begin_s + (time_us - first_us) / US_PER_S
        self._newest_us, self._newest_s = int(time_us[-1]), float(time_s[-1])
        batch = Batch(
            time_s=time_s,
            received_s=epoch_s + float(received_ns[-1]) * 1e-9,
            device_rad=judged.device_rad[part],
            model_rad=judged.model_rad[part],
            residual_rad=judged.residual_rad[part],
            mismatch=judged.mismatch[part],
            begins=judged.begins[part],
        )
        return Stretch(batch=batch, time_us=time_us, received_ns=received_ns, anew=anew)

    def _told(self, frame: Frame) -> None:
        self._validator.told(str(frame.message.param_id), float(frame.message.param_value))

    def _is_ours(self, frame: Frame) -> bool:
        if frame.name != SAMPLE:
            return False
        if frame.source == self.source:
            return True
        if self.source is None and self._system in (None, frame.source[0]):
            self.source = frame.source
            self._take_earlier()
            return True
        self._tell_other(frame.source)
        return False

    def _is_our_state(self, frame: Frame) -> bool:
        return frame.name == STATE and frame.source == self.source and not frame.repeated

    def _tell_other(self, source: Source) -> None:
        if source in self._others or len(self._others) >= MOST_OTHERS:
            return
        self._others.add(source)
        self._notices.add(
            "warning",
            f"system {source[0]}, component {source[1]} sends samples too; they are passed over "
            f"(--system {source[0]} takes them)",
        )


def _rising(time_us: NDArray[np.int64]) -> list[slice]:
    """Return the stretches in which time does not go back."""
    if not len(time_us):
        return []
    breaks = np.flatnonzero(np.diff(time_us) < 0) + 1
    ends = [*breaks.tolist(), len(time_us)]
    return [slice(a, b) for a, b in zip([0, *ends[:-1]], ends, strict=True)]
