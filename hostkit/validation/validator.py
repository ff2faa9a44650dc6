"""Holding a device against its models, step by step, as its samples arrive."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from hostkit.attitude import wrap_rad
from hostkit.errors import HostkitError
from hostkit.filters import FILTERS
from hostkit.records import AXES, AngleTrace, FilterDesign, ResidualStatistics, ValidationReport
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import Counts, to_rate_and_force_g
from hostkit.validation.checks import checks
from hostkit.validation.histogram import Histogram
from hostkit.validation.judged import Judged
from hostkit.validation.order import SampleOrder, places
from hostkit.validation.residual import ResidualTracker
from hostkit.validation.retuning import Model, Retuning, runs
from hostkit.validation.thresholds import Thresholds

Vector = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]


class Validator:
    """Compares a device with the integer and the float model of a design.

    Every step is computed again from the raw counts and the state *before* it, which the device
    sent with the previous sample, so that a loss costs the check of one step and no more. The
    float model runs on from step to step; after a loss it starts from the device's state.

    A device that says RETUNED is judged with the parameters that it told; until it has told all of
    them its samples are not judged.

    Parameters
    ----------
    design
        The design the device is said to run.
    tolerance_rad
        How far a filter in float may be from the running float model; None for one in integers,
        whose every bit must be the integer model's.
    as_designed
        Refuse a device that runs its design with other parameters, instead of following them.

    Attributes
    ----------
    spec
        The design in integers.
    """

    def __init__(
        self,
        design: FilterDesign,
        *,
        tolerance_rad: float | None = None,
        as_designed: bool = False,
    ) -> None:
        if tolerance_rad is not None and not (math.isfinite(tolerance_rad) and tolerance_rad > 0):
            raise HostkitError(f"tolerance_rad = {tolerance_rad}; it must be a number above 0")
        self._design = design
        self._tolerance_rad = tolerance_rad
        self._as_designed = as_designed
        self._filter = FILTERS[design.filter]
        self._part = SENSORS[design.sensor.part]
        self._retuning = Retuning(design)
        self.spec = self._retuning.designed.spec
        self._order = SampleOrder()
        self._state: IntArray | None = None
        self._float_state: Vector | None = None
        self._elapsed = 0
        self._is_retuned = False
        self.restart()

    def restart(self) -> None:
        """Forget the figures so far; the models go on."""
        self._order.forget_figures()
        self._samples = self.checked = self.mismatches = self._unjudged = 0
        self._was_retuned = self._is_retuned
        axes = AXES[self._design.axes]
        self._trackers = tuple(ResidualTracker(axis, self._design.period_s) for axis in axes)

    def begin_epoch(self, *, parameters_kept: bool = False) -> None:
        """Take the next sample as one that does not follow: it begins anew, and nothing was lost.

        Parameters
        ----------
        parameters_kept
            Whether the device uses the parameters that it told before.
        """
        self._order.begin()
        if not parameters_kept:
            self._retuning.forget()

    def told(self, name: str, value: float) -> None:
        """Take a parameter that the device told: the samples behind it were made with it."""
        self._retuning.told(name, value)

    @property
    def samples(self) -> int:
        """Samples that came, each once."""
        return self._samples

    @property
    def lost(self) -> int:
        """Samples that never came."""
        return self._order.lost

    @property
    def untold(self) -> tuple[str, ...]:
        """Parameters that the device uses and has not told; empty while it runs its design."""
        return self._retuning.untold if self._is_retuned else ()

    def add(self, trace: AngleTrace) -> Judged:
        """Take further samples.

        Returns
        -------
        Judged
            What came in order, beside the models.
        """
        trace, step, anew = self._in_order(trace)
        device = trace.state_raw * np.array(self.spec.state_per_unit)
        model, wrong = np.full_like(device, np.nan), np.zeros(len(trace), dtype=np.bool_)
        follows = (step == 1) & ~anew
        retuned = np.zeros_like(follows) if trace.retuned is None else trace.retuned
        for run in runs(retuned.tolist()) if len(trace) else ():
            used = self._model(is_retuned=bool(retuned[run.start]))
            if used is None:
                self._unjudged += run.stop - run.start
                self._float_state, self._state = device[run][-1], trace.state_raw[run][-1:]
            else:
                part = _part(trace, run)
                model[run] = self._follow_float(used, part, follows[run], device[run])
                wrong[run] = self._check_steps(used, part, follows[run], device[run], model[run])
        return self._judged(trace, step, ~follows, device, model, wrong)

    def _in_order(self, trace: AngleTrace) -> tuple[AngleTrace, IntArray, BoolArray]:
        """Return the samples that are to be judged, their steps, and where the counter is new."""
        columns = (trace.time_us[:, None], trace.accel_count, trace.gyro_count, trace.state_raw)
        contents = [row.tobytes() for row in np.hstack(columns)]
        restarts = self._order.restarts
        found = places(self._order, trace.sequence.tolist(), contents, trace.restarted.tolist())
        names = [place for place, _ in found]
        self._samples += len(names) - names.count("repeated")
        kept = np.array([name not in ("late", "repeated") for name in names], dtype=np.bool_)
        anew = np.array([name == "anew" for name in names], dtype=np.bool_)
        if self._order.restarts > restarts:
            self._retuning.forget()
        step = np.array([step for _, step in found], dtype=np.int64)
        return (trace, step, anew) if kept.all() else (_part(trace, kept), step[kept], anew[kept])

    def _model(self, *, is_retuned: bool) -> Model | None:
        self._is_retuned = is_retuned
        self._was_retuned |= is_retuned
        if not is_retuned:
            return self._retuning.designed
        return None if self._as_designed else self._retuning.retuned_model()

    def _follow_float(
        self, used: Model, trace: AngleTrace, follows: BoolArray, device: Vector
    ) -> Vector:
        """Return the states of the float model; NaN where it started from the device."""
        counts = Counts(accel=trace.accel_count, gyro=trace.gyro_count)
        rate, force = to_rate_and_force_g(self._part, self._design.sensor, counts)
        exact = np.full_like(device, np.nan)
        starts = [0, *(int(k) for k in np.flatnonzero(~follows) if k > 0), len(trace)]
        for begin, end in pairwise(starts):
            state = self._float_state
            if trace.restarted[begin]:
                state = None
            elif not follows[begin]:
                state, begin = device[begin], begin + 1
            run = slice(begin, end)
            if begin < end:
                exact[run] = self._filter.run_float(used.design, rate[run], force[run], state)
                state = exact[end - 1]
            self._float_state = state
        return exact

    def _check_steps(
        self, used: Model, trace: AngleTrace, follows: BoolArray, device: Vector, exact: Vector
    ) -> BoolArray:
        """Tell which steps are wrong, and count them."""
        judged = follows | trace.restarted
        if self._tolerance_rad is None:
            differs = self._expected(used, trace) != trace.state_raw
            wrong: BoolArray = differs.any(axis=1) & judged
        else:
            axes = len(self.spec.axes)
            away = np.abs(wrap_rad(device[:, :axes] - exact[:, :axes]))
            wrong = (away > self._tolerance_rad).any(axis=1) & judged
        self._state = trace.state_raw[-1:]
        self.checked += int(judged.sum())
        self.mismatches += int(wrong.sum())
        return wrong

    def _expected(self, used: Model, trace: AngleTrace) -> IntArray:
        before = trace.state_raw[:1] if self._state is None else self._state
        before = np.concatenate([before, trace.state_raw[:-1]])
        accel, gyro = trace.accel_count, trace.gyro_count
        expected = self._filter.step_integer(used.spec, before, accel, gyro)
        for k in np.flatnonzero(trace.restarted):
            one = slice(k, k + 1)
            expected[one] = self._filter.run_integer(used.spec, accel[one], gyro[one])
        return expected

    def _judged(
        self,
        trace: AngleTrace,
        step: IntArray,
        begins: BoolArray,
        device: Vector,
        model: Vector,
        wrong: BoolArray,
    ) -> Judged:
        """Take the residual into the figures."""
        axes = len(self.spec.axes)
        device, model = device[:, :axes], model[:, :axes]
        residual = wrap_rad(device - model)
        if len(trace):
            elapsed = self._elapsed + np.cumsum(step)
            self._elapsed = int(elapsed[-1])
            self._track(elapsed.astype(np.float64) * self._design.period_s, model, residual, begins)
        return Judged(
            time_us=trace.time_us,
            device_rad=device,
            model_rad=model,
            residual_rad=residual,
            mismatch=wrong,
            begins=begins,
        )

    def _track(self, time_s: Vector, model: Vector, residual: Vector, begins: BoolArray) -> None:
        known = np.isfinite(residual[:, 0])
        broken = np.where(begins[:, None], np.nan, residual)
        for i, tracker in enumerate(self._trackers):
            tracker.add(time_s[known], residual[known, i])
            tracker.follow(model[:, i], broken[:, i])

    def histograms(self) -> tuple[Histogram, ...]:
        """Return how the size of the residual is spread, rad, one for each axis of the design."""
        return tuple(tracker.histogram() for tracker in self._trackers)

    def report(
        self, thresholds: Thresholds, *, other_digest: str | None = None
    ) -> ValidationReport:
        """Give the verdict on what was taken so far.

        Parameters
        ----------
        thresholds
            What passes.
        other_digest
            Digest of the design that the device runs, if it is another one.
        """
        figures = self._figures(digest_ok=other_digest is None)
        if other_digest is not None:
            reasons: tuple[str, ...] = (f"the device runs design {other_digest}",)
        elif self._as_designed and self._was_retuned:
            reasons = (
                "the device runs its design with other parameters, set over the link, calibrated "
                "or stored; PREFLIGHT_STORAGE with 2 gives it the design's again",
            )
        else:
            reasons = tuple(c.reason for c in checks(figures, thresholds) if c.reason)
            return replace(figures, verdict="fail" if reasons else "pass", reasons=reasons)
        return replace(figures, verdict="refused", reasons=reasons)

    def _figures(self, *, digest_ok: bool) -> ValidationReport:
        count = sum(tracker.count for tracker in self._trackers)
        squares = sum(tracker.squares for tracker in self._trackers)
        residual: list[ResidualStatistics] = [
            found for t in self._trackers if (found := t.statistics()) is not None
        ]
        return ValidationReport(
            samples=self._samples,
            checked=self.checked,
            lost=self.lost,
            mismatches=self.mismatches,
            rms_rad=math.sqrt(squares / count) if count else None,
            max_rad=max((t.max_rad for t in self._trackers), default=0.0) if count else None,
            digest_ok=digest_ok,
            verdict="fail",
            late=self._order.late,
            repeated=self._order.repeated,
            unjudged=self._unjudged + self._order.thinned,
            stride=self._order.widest_stride,
            untold=self.untold,
            residual=tuple(residual),
            retuned=self._retuning.differences() if self._was_retuned else (),
        )


def _part(trace: AngleTrace, which: slice | BoolArray) -> AngleTrace:
    return AngleTrace(
        sequence=trace.sequence[which],
        time_us=trace.time_us[which],
        accel_count=trace.accel_count[which],
        gyro_count=trace.gyro_count[which],
        state_raw=trace.state_raw[which],
        restarted=trace.restarted[which],
        retuned=None if trace.retuned is None else trace.retuned[which],
    )
