"""Picking the samples of one device out of a stream and holding them against the models."""

from collections.abc import Iterator

import numpy as np

from hostkit.design_file import digest
from hostkit.link.decoder import Frame, Source, digest_of, is_retuned, trace_of
from hostkit.monitor.notices import Notices
from hostkit.monitor.snapshot import Batch
from hostkit.records import AXES, FilterDesign
from hostkit.validation import Validator

MOST_OTHERS = 8
"""Other devices that are told of; a hostile stream may claim any number."""

US_PER_S = 1e6
RESET_US = 1_000_000
"""A device whose time goes back by more than this has started anew."""


class Judge:
    """Follows the first device that sends samples, or the one of a given system.

    Attributes
    ----------
    source
        Whose samples are judged; None until one came.
    other_digest
        Digest of the design that the device runs, if it is another one.
    retuned
        Whether the device was refused because of its parameters.
    epoch
        Rises whenever device time begins anew.
    """

    def __init__(
        self, design: FilterDesign, validator: Validator, notices: Notices, system: int | None
    ) -> None:
        self._design, self.validator = design, validator
        self._notices, self._system = notices, system
        self._digest = digest(design)
        self._others: set[Source] = set()
        self._origin_us: int | None = None
        self._offset_s = 0.0
        self._newest_us = 0
        self._newest_s = 0.0
        self.source: Source | None = None
        self.other_digest: str | None = None
        self.retuned = False
        self.epoch = 0
        self.samples = 0

    @property
    def refused(self) -> bool:
        """Whether the device cannot be judged."""
        return self.other_digest is not None or self.retuned

    def begin_epoch(self) -> None:
        """Take the next sample for the first: the port was opened anew, or the replay moved."""
        self.epoch += 1
        self._origin_us = None
        self.other_digest, self.retuned = None, False

    def take(self, frames: list[Frame], received_s: float, position_s: float) -> Iterator[Batch]:
        """Judge the samples among some frames.

        Parameters
        ----------
        received_s
            Host time of arrival, s since 1970.
        position_s
            Where the time axis stands, s: what is shown first in a new epoch is put there.
        """
        samples = [frame for frame in frames if self._is_ours(frame)]
        good = []
        for frame in samples:
            if digest_of(frame) != self._digest:
                self.other_digest = digest_of(frame)
                break
            if is_retuned(frame):
                self.retuned = True
                break
            good.append(frame)
        if self.refused or not good:
            return
        self.samples += len(good)
        hidden_words = len(self.validator.spec.hidden)
        trace = trace_of(good, AXES[self._design.axes], hidden_words=hidden_words)
        residual = self.validator.add(trace)
        device = trace.state_raw[:, : residual.shape[1]] * self.validator.spec.state_per_unit[0]
        flags = np.zeros(len(trace), dtype=np.bool_)
        yield Batch(
            time_s=self._time_s(trace.time_us, position_s),
            received_s=received_s,
            device_rad=device,
            model_rad=device - residual,
            residual_rad=residual,
            mismatch=flags,
            begins=flags.copy(),
        )

    def _time_s(self, time_us: np.ndarray, position_s: float) -> np.ndarray:
        if self._origin_us is None or time_us[0] < self._newest_us - RESET_US:
            if self._origin_us is not None:
                self.epoch += 1
                self._notices.add("warning", "the device has started anew")
            self._origin_us = int(time_us[0])
            self._offset_s = position_s
        self._newest_us = int(time_us[-1])
        time_s = self._offset_s + (time_us - self._origin_us) / US_PER_S
        self._newest_s = float(time_s[-1])
        return time_s

    def _is_ours(self, frame: Frame) -> bool:
        if frame.name != "TILT_SAMPLE":
            return False
        if frame.source == self.source:
            return True
        if self.source is None and self._system in (None, frame.source[0]):
            self.source = frame.source
            return True
        self._tell_other(frame.source)
        return False

    def _tell_other(self, source: Source) -> None:
        if source in self._others or len(self._others) >= MOST_OTHERS:
            return
        self._others.add(source)
        self._notices.add(
            "warning",
            f"system {source[0]}, component {source[1]} sends samples too; they are passed over "
            f"(--system {source[0]} takes them)",
        )
