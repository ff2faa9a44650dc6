"""Computing the steps of a device again, beside it."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from hostkit.attitude import apart_rad
from hostkit.filters import FILTERS
from hostkit.records import FilterDesign
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import Counts, to_rate_and_force_g
from hostkit.trace import AngleTrace
from hostkit.validation.retuning import Model

Vector = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]


@dataclass(slots=True, kw_only=True)
class Steps:
    """Steps that were computed again; arrays that are still to be written.

    Attributes
    ----------
    exact
        Angles of the float model, shape ``(N, A)``; NaN where it could not follow.
    judged, wrong
        Which steps were checked, and which of them are wrong, shape ``(N,)``.
    confirmed
        How many right steps they stand for, where a change of parameters is doubted.
    """

    exact: Vector
    judged: BoolArray
    wrong: BoolArray
    confirmed: int = 0

    def withdraw(self, first: int) -> None:
        """Judge nothing from a sample on."""
        self.exact[first:] = np.nan
        self.judged[first:] = self.wrong[first:] = False


class Follower:
    """Runs the integer and the float model of a design beside a device.

    An integer step starts from the state that the device sent with the sample before. The float
    model runs on from step to step, and starts from the device's state where it cannot.

    Parameters
    ----------
    tolerance_rad
        As in :class:`hostkit.validation.Validator`.
    """

    waits = needs_state = False

    def __init__(self, design: FilterDesign, designed: Model, tolerance_rad: float | None) -> None:
        self._sensor = design.sensor
        self._filter = FILTERS[design.filter]
        self._part = SENSORS[design.sensor.part]
        self._axes = len(designed.spec.axes)
        self._per_unit = np.array(designed.spec.state_per_unit)
        self._tolerance_rad = tolerance_rad
        self._state: IntArray | None = None
        self._float_state: Vector | None = None

    def forget(self) -> None:
        """Know nothing of the device; a sample that does not follow makes up for that."""

    def hear(self, trace: AngleTrace, *, anew: bool) -> int:
        """Pass over states beside the samples: these have it all."""
        return 0

    def device_rad(self, trace: AngleTrace) -> Vector:
        """Return the angles of the device, shape ``(N, A)``."""
        angles: Vector = (trace.state_raw * self._per_unit)[:, : self._axes]
        return angles

    def skip(self, trace: AngleTrace) -> None:
        """Pass over samples that no model can follow; both models start from the last of them."""
        self._state = trace.state_raw[-1:]
        self._float_state = self._state[0] * self._per_unit

    def run(self, used: Model, trace: AngleTrace, follows: BoolArray) -> Steps:
        """Compute some steps, one at least.

        Parameters
        ----------
        used
            The model whose parameters the samples were made with.
        follows
            Which samples come right after the one before, shape ``(N,)``.
        """
        judged = follows | trace.restarted
        exact = self._follow_float(used, trace, follows)[:, : self._axes]
        if self._tolerance_rad is None:
            wrong = (self._expected(used, trace) != trace.state_raw).any(axis=1)
        else:
            away = apart_rad(self.device_rad(trace), exact)
            wrong = ~(away <= self._tolerance_rad)  # NaN is wrong
        self._state = trace.state_raw[-1:]
        confirmed = int(judged.sum())
        return Steps(exact=exact, judged=judged, wrong=wrong & judged, confirmed=confirmed)

    def _expected(self, used: Model, trace: AngleTrace) -> IntArray:
        before = trace.state_raw[:1] if self._state is None else self._state
        before = np.concatenate([before, trace.state_raw[:-1]])
        accel, gyro = trace.accel_count, trace.gyro_count
        expected = self._filter.step_integer(used.spec, before, accel, gyro)
        for k in np.flatnonzero(trace.restarted):
            one = slice(k, k + 1)
            expected[one] = self._filter.run_integer(used.spec, accel[one], gyro[one])
        return expected

    def _follow_float(self, used: Model, trace: AngleTrace, follows: BoolArray) -> Vector:
        counts = Counts(accel=trace.accel_count, gyro=trace.gyro_count)
        rate, force = to_rate_and_force_g(self._part, self._sensor, counts)
        device = trace.state_raw * self._per_unit
        exact: Vector = np.full(device.shape, np.nan)
        broken = np.flatnonzero(~follows | trace.restarted)
        for begin, end in pairwise([0, *(int(k) for k in broken if k > 0), len(trace)]):
            state, first = self._float_state, begin
            if trace.restarted[begin]:
                state = None
            elif not follows[begin]:
                state, first = device[begin], begin + 1
            if first < end:
                run = slice(first, end)
                exact[run] = self._filter.run_float(used.design, rate[run], force[run], state)
                state = exact[end - 1]
            self._float_state = state
        return exact
