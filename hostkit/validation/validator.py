"""Holding a device against its models as its samples arrive, and giving a verdict."""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hostkit.attitude import wrap_rad
from hostkit.errors import HostkitError
from hostkit.records import AXES, FilterDesign, ValidationReport
from hostkit.trace import AngleTrace
from hostkit.validation.checks import checks
from hostkit.validation.follower import Follower, Steps
from hostkit.validation.histogram import Histogram
from hostkit.validation.judged import Judged
from hostkit.validation.order import SampleOrder, places
from hostkit.validation.residual import ResidualTracker
from hostkit.validation.retuning import Model, Retuning, runs
from hostkit.validation.state_follower import StateFollower
from hostkit.validation.thresholds import Thresholds
from hostkit.validation.waiting import Waiting

Vector = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]


class Validator:
    """Compares a device with the integer and the float model of a design.

    Every step is computed again from the raw counts and the state *before* it, which the device
    sent with the previous sample, so that a loss costs the check of one step and no more. The
    float model runs on from step to step; after a loss it starts from the device's state.

    The samples of a filter with a long state do not hold all of it: its models run on from step
    to step, and after a loss until the device tells its state, the samples are not judged.

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
    checked, mismatches
        Steps that were computed again, and those of them that are wrong.
    samples
        Samples that came, each once.
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
        self._axes, self._period_s = AXES[design.axes], design.period_s
        self._as_designed, self._tolerance_rad = as_designed, tolerance_rad
        self._retuning = Retuning(design)
        self.spec = self._retuning.designed.spec
        follower = StateFollower if self.spec.tells_state else Follower
        self._follower = follower(design, self._retuning.designed, tolerance_rad)
        self._order = SampleOrder()
        self._waiting = Waiting()
        self._elapsed = 0
        self._is_retuned = False
        self.restart()

    def restart(self) -> None:
        """Forget the figures so far; the models go on."""
        self._order.forget_figures()
        self.samples = self.checked = self.mismatches = self._unjudged = 0
        self._waiting.forget_figures()
        self._was_retuned = self._is_retuned
        self._retuning.drop_withheld()
        self._trackers = tuple(ResidualTracker(axis, self._period_s) for axis in self._axes)

    def begin_epoch(self) -> None:
        """Take the next sample as one that does not follow: it begins anew, and nothing was lost.

        The device may have started anew, so what it told of its parameters is forgotten.
        """
        self._order.begin()
        self._follower.forget()
        self._retuning.forget()

    def told(self, name: str, value: float) -> None:
        """Take a parameter that the device told: the samples behind it were made with it."""
        self._retuning.told(name, value)

    def doubt_parameters(self) -> None:
        """Say that a frame was lost which may have told of a parameter.

        If steps of a retuned device are wrong from here on, they are withheld until it has told
        all of its parameters again, and count only if those are the same as before.
        """
        self._retuning.doubt()

    @property
    def lost(self) -> int:
        """Samples that never came."""
        return self._order.lost

    @property
    def untold(self) -> tuple[str, ...]:
        """Parameters that the device uses and has not told; empty while it runs its design."""
        return self._retuning.untold if self._is_retuned else ()

    @property
    def needs_state(self) -> bool:
        """Whether samples wait for the device to tell the state of its filter."""
        return self.samples > 0 and self._follower.needs_state

    def add(self, trace: AngleTrace) -> Judged:
        """Take further samples.

        Returns
        -------
        Judged
            What came in order, beside the models.
        """
        trace, step, follows, anew = self._in_order(trace)
        device = self._follower.device_rad(trace)
        model = np.full((len(trace), len(self._axes)), np.nan)
        wrong = np.zeros(len(trace), dtype=np.bool_)
        retuned = np.zeros_like(follows) if trace.retuned is None else trace.retuned
        for piece in _pieces(anew):
            self._hear(trace.part(piece), anew=bool(anew[piece][:1].any()))
            for run in runs(retuned[piece].tolist()):
                part = slice(piece.start + run.start, piece.start + run.stop)
                used = self._model(is_retuned=bool(retuned[part.start]))
                steps = self._judge(used, trace.part(part), follows[part])
                if steps is not None:
                    model[part], wrong[part] = steps.exact, steps.wrong
        residual = wrap_rad(device - model)
        self._track(step, model, residual, ~follows)
        return Judged(
            time_us=trace.time_us,
            device_rad=device,
            model_rad=model,
            residual_rad=residual,
            mismatch=wrong,
            begins=~follows,
        )

    def _in_order(self, trace: AngleTrace) -> tuple[AngleTrace, IntArray, BoolArray, BoolArray]:
        """Return the samples to be judged, their steps, which follow, and which begin anew."""
        columns = (trace.time_us[:, None], trace.accel_count, trace.gyro_count, trace.state_raw)
        contents = [row.tobytes() for row in np.hstack(columns)]
        restarts = self._order.restarts
        found = places(self._order, trace.sequence.tolist(), contents, trace.restarted.tolist())
        names = [place for place, _ in found]
        self.samples += len(names) - names.count("repeated")
        if self._order.restarts > restarts:
            self._retuning.forget()
        elif "gap" in names:
            self._retuning.doubt()
        kept = np.array([name not in ("late", "repeated") for name in names], dtype=np.bool_)
        follows = np.array([name == "follows" for name in names], dtype=np.bool_)
        anew = np.array([name == "anew" for name in names], dtype=np.bool_)
        step = np.array([step for _, step in found], dtype=np.int64)
        if kept.all():
            return trace, step, follows, anew
        return trace.part(kept), step[kept], follows[kept], anew[kept]

    def _hear(self, trace: AngleTrace, *, anew: bool) -> None:
        """Count wrong states that came apart from their samples."""
        wrong = self._follower.hear(trace, anew=anew)
        if wrong and self._is_retuned and self._retuning.doubted:
            self._retuning.withhold(wrong, wrong)
            self._unjudged += wrong
            return
        self.mismatches += wrong
        self.checked += wrong

    def _model(self, *, is_retuned: bool) -> Model | None:
        self._is_retuned = is_retuned
        self._was_retuned |= is_retuned
        if not is_retuned:
            self._retuning.is_designed()
            return self._retuning.designed
        return None if self._as_designed else self._retuning.retuned_model()

    def _judge(self, used: Model | None, trace: AngleTrace, follows: BoolArray) -> Steps | None:
        if used is None:
            self._unjudged += len(trace)
            self._follower.skip(trace)
            return None
        steps = self._follower.run(used, trace, follows)
        self._count_withheld()
        wrong, checked = int(steps.wrong.sum()), int(steps.judged.sum())
        if self._follower.waits:
            self._unjudged += self._waiting.add(steps.judged)
        if wrong and self._is_retuned and self._retuning.doubted:
            first = int(steps.wrong.argmax())
            later = int(steps.judged[first:].sum())
            self._retuning.withhold(wrong, later)
            steps.withdraw(first)
            self._follower.skip(trace)
            self._unjudged += later if self._follower.waits else len(trace) - first
            wrong, checked = 0, checked - later
        elif not wrong:
            self._retuning.agreed(steps.confirmed)
        self.mismatches += wrong
        self.checked += checked
        return steps

    def _count_withheld(self) -> None:
        """Count wrong steps that were withheld, now that the device has told the same again."""
        wrong, checked = self._retuning.take_withheld()
        self.mismatches += wrong
        self.checked += checked
        self._unjudged -= checked

    def _track(self, step: IntArray, model: Vector, residual: Vector, begins: BoolArray) -> None:
        """Take the residual into the figures."""
        if not len(step):
            return
        elapsed = self._elapsed + np.cumsum(step)
        self._elapsed = int(elapsed[-1])
        time_s = elapsed.astype(np.float64) * self._period_s
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
            refusal = f"the device runs design {other_digest}"
        elif self._as_designed and self._was_retuned:
            refusal = (
                "the device runs its design with other parameters, set over the link, calibrated "
                "or stored; PREFLIGHT_STORAGE with 2 gives it the design's again"
            )
        else:
            reasons = tuple(c.reason for c in checks(figures, thresholds) if c.reason)
            return replace(figures, verdict="fail" if reasons else "pass", reasons=reasons)
        return replace(figures, verdict="refused", reasons=(refusal,))

    def _figures(self, *, digest_ok: bool) -> ValidationReport:
        count = sum(tracker.count for tracker in self._trackers)
        squares = sum(tracker.squares for tracker in self._trackers)
        residual = [tracker.statistics() for tracker in self._trackers]
        return ValidationReport(
            samples=self.samples,
            checked=self.checked,
            lost=self.lost,
            mismatches=self.mismatches,
            rms_rad=math.sqrt(squares / count) if count else None,
            max_rad=max(t.max_rad for t in self._trackers) if count else None,
            digest_ok=digest_ok,
            verdict="fail",
            late=self._order.late,
            repeated=self._order.repeated,
            unjudged=min(self.samples, self._unjudged + self._order.thinned),
            waiting=min(self.samples, self._waiting.samples),
            longest_wait_s=self._waiting.longest * self._period_s,
            stride=self._order.widest_stride,
            tolerance_rad=self._tolerance_rad,
            untold=self.untold,
            residual=tuple(entry for entry in residual if entry is not None),
            retuned=self._retuning.differences() if self._was_retuned else (),
        )


def _pieces(anew: BoolArray) -> list[slice]:
    """Return the stretches of samples of one run of the device; one at least, if empty."""
    begins = [0, *(int(k) for k in np.flatnonzero(anew) if k > 0)]
    return [slice(a, b) for a, b in zip(begins, [*begins[1:], len(anew)], strict=True)]
