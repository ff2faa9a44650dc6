"""Computing the steps of a device again whose samples do not hold the whole state of its filter."""

from collections import deque
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from hostkit.attitude import apart_rad
from hostkit.filters import FILTERS
from hostkit.records import FilterDesign
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import Counts, to_rate_and_force_g
from hostkit.trace import AngleTrace, ToldState
from hostkit.validation.follower import Steps
from hostkit.validation.retuning import AGREEING_STEPS, Model
from hostkit.validation.told_states import ToldStates

Vector = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

RECENT = 64
"""Samples that are kept for a state that is told behind them."""

CONFIRMED_BY_STATE = AGREEING_STEPS // 2
"""A right state stands for so many right steps: two of them show that no change was missed."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Past:
    """A sample that was passed; no state where it is not known, no model where none made it."""

    sequence: int
    model: Model | None
    accel: IntArray
    gyro: IntArray
    angles: IntArray
    state: IntArray | None


class StateFollower:
    """Runs the integer and the float model of a design beside a device that tells its state.

    Both models run on from step to step. Where they cannot, after a gap or when the device is met
    in mid-flight, they take up at the next state that it tells; a sample that says RESTARTED
    begins anew. Angles are compared with every sample, all words with every told state. A state
    that is wrong is taken up, too, so that what follows it is judged by itself.

    The state of the float model is kept in units of the words. What one of them is worth may depend
    on a parameter; when that is changed a device in integers keeps its words, and one in float,
    which tells them in units of its design, what they are worth.

    Parameters
    ----------
    tolerance_rad
        As in :class:`hostkit.validation.Validator`; the words of a filter in float are taken up
        and not compared.
    """

    waits = True

    def __init__(self, design: FilterDesign, designed: Model, tolerance_rad: float | None) -> None:
        self._sensor = design.sensor
        self._filter = FILTERS[design.filter]
        self._part = SENSORS[design.sensor.part]
        self._axes = len(designed.spec.axes)
        self._per_unit = np.array(designed.spec.state_per_unit)
        self._tolerance_rad = tolerance_rad
        self.forget()

    def forget(self) -> None:
        """Know nothing of the device."""
        self._state: IntArray | None = None
        self._float_words: Vector | None = None
        self._recent: deque[_Past] = deque(maxlen=RECENT)
        self._told = ToldStates()
        self._confirmed = 0

    @property
    def needs_state(self) -> bool:
        """Whether no sample can be computed before a state is told."""
        return self._float_words is None

    def device_rad(self, trace: AngleTrace) -> Vector:
        """Return the angles of the device, shape ``(N, A)``."""
        angles: Vector = trace.state_raw[:, : self._axes] * self._per_unit[: self._axes]
        return angles

    def hear(self, trace: AngleTrace, *, anew: bool) -> int:
        """Take the states that came with some samples, before these are run.

        Parameters
        ----------
        anew
            Whether the sample counter began anew with the first of them.

        Returns
        -------
        int
            Wrong states that are not those of a sample of this trace.
        """
        if anew:
            self._recent.clear()
        known = {past.sequence for past in self._recent}
        sorted_out = self._told.sort(trace.told, trace.sequence.tolist(), known, anew=anew)
        return sorted_out.wrong + sum(self._compare_late(told) for told in sorted_out.late)

    def skip(self, trace: AngleTrace) -> None:
        """Pass over samples that no model can follow."""
        self._break()
        words = self._told.of(int(trace.sequence[-1]))
        if words is not None:
            self._take_up(trace.state_raw[-1], words)
        self._remember(None, trace, len(trace) - 1, [self._state])

    def run(self, used: Model, trace: AngleTrace, follows: BoolArray) -> Steps:
        """Compute some steps, one at least.

        Parameters
        ----------
        used
            The model whose parameters the samples were made with.
        follows
            Which samples come right after the one before, shape ``(N,)``.
        """
        counts = Counts(accel=trace.accel_count, gyro=trace.gyro_count)
        si = to_rate_and_force_g(self._part, self._sensor, counts)
        steps = Steps(
            exact=np.full((len(trace), self._axes), np.nan),
            judged=np.zeros(len(trace), dtype=np.bool_),
            wrong=np.zeros(len(trace), dtype=np.bool_),
        )
        told = [self._told.of(number) for number in trace.sequence.tolist()]
        anew = trace.restarted | ~follows
        breaks = {0, len(trace), *np.flatnonzero(anew).tolist()}
        breaks |= {k + 1 for k, words in enumerate(told) if words is not None}
        for begin, end in pairwise(sorted(breaks)):
            if anew[begin]:
                self._break()
            states: list[IntArray | None] = [None] * (end - begin)
            if trace.restarted[begin] or self._float_words is not None:
                states = self._stretch(used, trace, slice(begin, end), si, steps)
            self._remember(used, trace, begin, states)
            words = told[end - 1]
            if words is not None:
                steps.wrong[end - 1] |= self._differs(words)
                self._take_up(trace.state_raw[end - 1], words)
        steps.confirmed, self._confirmed = self._confirmed, 0
        return steps

    def _stretch(
        self,
        used: Model,
        trace: AngleTrace,
        which: slice,
        si: tuple[Vector, Vector],
        steps: Steps,
    ) -> list[IntArray | None]:
        """Run both models through samples without a break; return the states behind them."""
        rate, force = si[0][which], si[1][which]
        exact = self._run_float(used, rate, force)
        steps.exact[which] = exact[:, : self._axes]
        steps.judged[which] = True
        if self._tolerance_rad is not None:
            away = apart_rad(self.device_rad(trace)[which], exact[:, : self._axes])
            steps.wrong[which] = ~(away <= self._tolerance_rad)  # NaN is wrong
            return [None] * len(exact)
        accel, gyro = trace.accel_count[which], trace.gyro_count[which]
        states = self._filter.run_integer(used.spec, accel, gyro, self._state)
        self._state = states[-1]
        angles = trace.state_raw[which, : self._axes]
        steps.wrong[which] = (states[:, : self._axes] != angles).any(axis=1)
        return list(states)

    def _run_float(self, used: Model, rate_rad_s: Vector, force_g: Vector) -> Vector:
        """Run the float model on; return its states."""
        per_unit = self._per_unit
        if self._tolerance_rad is None:
            per_unit = np.array(used.spec.state_per_unit)
        start = None if self._float_words is None else self._float_words * per_unit
        states = self._filter.run_float(used.design, rate_rad_s, force_g, start)
        self._float_words = states[-1] / per_unit
        return states

    def _differs(self, words: tuple[int, ...]) -> bool:
        """Compare a told state with that of the model, if there is one."""
        if self._state is None or self._tolerance_rad is not None:
            return False
        differs = tuple(self._state[self._axes :].tolist()) != words
        self._confirmed = 0 if differs else self._confirmed + CONFIRMED_BY_STATE
        return differs

    def _take_up(self, angles: IntArray, words: tuple[int, ...]) -> None:
        """Go on from what the device told, unless the model has just that or runs in float."""
        if self._tolerance_rad is not None and self._float_words is not None:
            return
        state = np.array([*angles[: self._axes].tolist(), *words], dtype=np.int64)
        if self._state is None or (state != self._state).any():
            self._float_words = state.astype(np.float64)
        self._state = state

    def _compare_late(self, told: ToldState) -> bool:
        """Compare a state that came behind its sample; go on from it if it is news."""
        place = next(k for k, past in enumerate(self._recent) if past.sequence == told.sequence)
        past, *later = list(self._recent)[place:]
        if self._tolerance_rad is not None and self._float_words is not None:
            return False
        now = self._state
        self._state = past.state
        wrong = self._differs(told.words_raw)
        if past.state is not None and not wrong:
            self._state = now
            return False
        self._float_words = None
        self._take_up(past.angles, told.words_raw)
        for sample in later:
            self._catch_up(sample)
        return wrong

    def _catch_up(self, past: _Past) -> None:
        """Step both models through a sample that was passed before."""
        if past.model is None or self._state is None:
            self._state = self._float_words = None
            return
        counts = Counts(accel=past.accel[None], gyro=past.gyro[None])
        si = to_rate_and_force_g(self._part, self._sensor, counts)
        self._run_float(past.model, *si)
        spec = past.model.spec
        self._state = self._filter.run_integer(spec, counts.accel, counts.gyro, self._state)[-1]

    def _break(self) -> None:
        """Take the next sample as one that does not follow."""
        self._state = self._float_words = None
        self._recent.clear()

    def _remember(
        self, used: Model | None, trace: AngleTrace, begin: int, states: list[IntArray | None]
    ) -> None:
        """Keep the latest of some samples for a state that is told behind them."""
        for k in range(max(0, len(states) - RECENT), len(states)):
            self._recent.append(
                _Past(
                    sequence=int(trace.sequence[begin + k]),
                    model=used,
                    accel=trace.accel_count[begin + k],
                    gyro=trace.gyro_count[begin + k],
                    angles=trace.state_raw[begin + k],
                    state=states[k],
                )
            )
