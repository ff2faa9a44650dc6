"""From the samples of one device to the rows of a recording."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hostkit.design_file import digest
from hostkit.errors import HostkitError
from hostkit.link.frames.decoder import Frame, Source, digest_of
from hostkit.link.frames.samples import payloads
from hostkit.monitor.device_status import US_PER_S, deg_c
from hostkit.recordings.csv_file import ACCEL, GYRO
from hostkit.records import FilterDesign
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import Counts, to_rate_and_force_g
from hostkit.units import STANDARD_GRAVITY_M_S2

Vector = NDArray[np.float64]
Payloads = np.ndarray[tuple[int], np.dtype[np.void]]

COLUMNS = ("time_s", *GYRO, *ACCEL, "temp_c")
RESET_US = 1_000_000
"""A device whose time goes back by more than this has started anew; by less, a sample is late."""


class SampleRows:
    """Scales raw counts by the ranges of a design; time goes on where the device begins anew.

    Parameters
    ----------
    design
        What the device runs; a device with another design has other ranges and is refused.
    system
        Id of the system to take; None takes the first that sends samples.

    Attributes
    ----------
    left_out
        Samples that came late or again: the time of a recording must rise.
    """

    def __init__(self, design: FilterDesign, system: int | None = None) -> None:
        self._design, self._system = design, system
        self._digest = np.frombuffer(bytes.fromhex(digest(design)), dtype=np.uint8)
        self._source: Source | None = None
        self._period_us = US_PER_S / design.rate_hz
        self._origin_us = 0
        self._newest_us: int | None = None
        self._host_us = 0
        self.left_out = 0

    def take(self, epoch_us: int, frames: Sequence[Frame]) -> Vector:
        """Return a row for each sample, its columns as in `COLUMNS`.

        Parameters
        ----------
        epoch_us
            The time since 1970, us, at which the clock of the frames' arrivals was 0.

        Raises
        ------
        HostkitError
            If the device runs another design.
        """
        good = [frame for frame in frames if self._is_ours(frame)]
        if not good:
            return np.empty((0, len(COLUMNS)))
        read = payloads(good)
        self._require_design(good, read)
        times_us = [
            self._time_us(device_us, frame.time_us(epoch_us))
            for device_us, frame in zip(read["time_usec"].tolist(), good, strict=True)
        ]
        kept = np.array([time_us is not None for time_us in times_us], dtype=np.bool_)
        self.left_out += len(good) - int(kept.sum())
        time_s = np.array([t for t in times_us if t is not None], dtype=np.float64) / US_PER_S
        return self._rows(time_s, read[kept])

    def _rows(self, time_s: Vector, read: Payloads) -> Vector:
        sensor = self._design.sensor
        counts = Counts(accel=read["accel"].astype(np.int64), gyro=read["gyro"].astype(np.int64))
        rate, force_g = to_rate_and_force_g(SENSORS[sensor.part], sensor, counts)
        temperature = deg_c(read["temperature"].astype(np.float64))
        return np.column_stack((time_s, rate, force_g * STANDARD_GRAVITY_M_S2, temperature))

    def _require_design(self, frames: list[Frame], read: Payloads) -> None:
        others = np.flatnonzero((read["digest"] != self._digest).any(axis=1))
        if len(others):
            raise HostkitError(
                f"the device runs design {digest_of(frames[others[0]])}, not "
                f"{digest(self._design)}: the ranges of its sensor are not known"
            )

    def _is_ours(self, frame: Frame) -> bool:
        if frame.name != "TILT_SAMPLE":
            return False
        if self._source is None and self._system in (None, frame.source[0]):
            self._source = frame.source
        return frame.source == self._source

    def _time_us(self, device_us: int, host_us: int) -> int | None:
        """Return the time in the recording, or None for a sample that is late or came again."""
        if self._newest_us is None:
            self._origin_us = device_us
        elif device_us < self._newest_us - RESET_US:
            gap_us = max(int(self._period_us), host_us - self._host_us)
            self._origin_us = device_us - (self._newest_us - self._origin_us) - gap_us
        elif device_us <= self._newest_us:
            return None
        self._newest_us, self._host_us = device_us, host_us
        return device_us - self._origin_us
