"""From the samples of one device to the rows of a recording."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hostkit.design_file import digest
from hostkit.errors import HostkitError
from hostkit.link.decoder import Frame, Source, digest_of
from hostkit.monitor.device_status import US_PER_S, deg_c
from hostkit.recordings.csv_file import ACCEL, GYRO
from hostkit.records import FilterDesign
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import Counts, to_rate_and_force_g
from hostkit.units import STANDARD_GRAVITY_M_S2

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
        self._digest = bytes.fromhex(digest(design))
        self._source: Source | None = None
        self._period_us = US_PER_S / design.rate_hz
        self._origin_us = 0
        self._newest_us: int | None = None
        self._host_us = 0
        self.left_out = 0

    def take(self, host_us: int, frames: Sequence[Frame]) -> NDArray[np.float64]:
        """Return a row for each sample, its columns as in `COLUMNS`.

        Raises
        ------
        HostkitError
            If the device runs another design.
        """
        good = [frame for frame in frames if self._is_ours(frame)]
        kept, times_us = [], []
        for frame in good:
            time_us = self._time_us(int(frame.message.time_usec), host_us)
            if time_us is None:
                self.left_out += 1
                continue
            kept.append(frame.message)
            times_us.append(time_us)
        if not kept:
            return np.empty((0, len(COLUMNS)))
        return self._rows(kept, times_us)

    def _rows(self, messages: list[object], times_us: list[int]) -> NDArray[np.float64]:
        counts = Counts(
            accel=np.array([m.accel for m in messages], dtype=np.int64),  # type: ignore[attr-defined]
            gyro=np.array([m.gyro for m in messages], dtype=np.int64),  # type: ignore[attr-defined]
        )
        sensor = self._design.sensor
        rate, force_g = to_rate_and_force_g(SENSORS[sensor.part], sensor, counts)
        temperature = [deg_c(m.temperature) for m in messages]  # type: ignore[attr-defined]
        time_s = np.array(times_us) / US_PER_S
        return np.column_stack((time_s, rate, force_g * STANDARD_GRAVITY_M_S2, temperature))

    def _is_ours(self, frame: Frame) -> bool:
        if frame.name != "TILT_SAMPLE":
            return False
        if self._source is None and self._system in (None, frame.source[0]):
            self._source = frame.source
        if frame.source != self._source:
            return False
        if bytes(frame.message.digest) != self._digest:
            raise HostkitError(
                f"the device runs design {digest_of(frame)}, not {self._digest.hex()}: the ranges "
                "of its sensor are not known"
            )
        return True

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
