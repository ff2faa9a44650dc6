"""Holding a device against its models, step by step, as its samples arrive."""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from hostkit.attitude import wrap_rad
from hostkit.errors import HostkitError
from hostkit.filters import FILTERS
from hostkit.records import AngleTrace, FilterDesign, ValidationReport
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import Counts, to_rate_and_force_g
from hostkit.units import DEG_PER_RAD

Vector = NDArray[np.float64]
IntArray = NDArray[np.int64]

DEFAULT_MAX_RMS_DEG = 0.005
"""Largest residual against the float model that passes, deg."""

DEFAULT_MAX_LOST_SHARE = 0.01
"""Largest share of samples that may be lost on the way."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Thresholds:
    """What a device must keep to pass."""

    max_rms_deg: float = DEFAULT_MAX_RMS_DEG
    max_lost_share: float = DEFAULT_MAX_LOST_SHARE

    def __post_init__(self) -> None:
        """Refuse a threshold that nothing can exceed, or everything does."""
        for name in ("max_rms_deg", "max_lost_share"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value >= 0.0):
                raise HostkitError(f"{name} = {value}; it must be a finite number, 0 or more")


class Validator:
    """Compares a device with the integer and the float model of a design.

    Every step is computed again from the raw counts and the state *before* it, which the device
    sent with the previous sample, so that a loss costs the check of one step and no more. The
    float model runs on from step to step; after a loss it starts from the device's state.

    Parameters
    ----------
    design
        The design the device is said to run.

    Attributes
    ----------
    spec
        The design in integers.
    """

    def __init__(self, design: FilterDesign) -> None:
        self._design = design
        self._filter = FILTERS[design.filter]
        self._part = SENSORS[design.sensor.part]
        self.spec = self._filter.lower(design)
        self._sequence: int | None = None
        self._state: IntArray | None = None
        self._float_state: Vector | None = None
        self.samples = 0
        self.checked = 0
        self.lost = 0
        self.mismatches = 0
        self._residual_count = 0
        self._squares = 0.0
        self._max = 0.0

    def add(self, trace: AngleTrace) -> Vector:
        """Take further samples.

        Returns
        -------
        numpy.ndarray
            Residual device minus float model, rad, shape ``(N, A)``; zero where the float model
            was started from the device.
        """
        if not len(trace):
            return np.empty((0, len(self.spec.axes)))
        follows = self._follows(trace)
        self._check_steps(trace, follows)
        residual = self._follow_float(trace, follows)
        self.samples += len(trace)
        self._sequence = int(trace.sequence[-1])
        self._state = trace.state_raw[-1:]
        return residual

    def _follows(self, trace: AngleTrace) -> NDArray[np.bool_]:
        """Tell which samples come right after the one before, and count what is between."""
        first = trace.sequence[0] - 1 if self._sequence is None else self._sequence
        step = np.diff(trace.sequence, prepend=first)
        gap = ~trace.restarted & (step > 1)
        self.lost += int((step[gap] - 1).sum())
        follows: NDArray[np.bool_] = ~trace.restarted & (step == 1)
        if self._sequence is None:
            follows[0] = False
        return follows

    def _check_steps(self, trace: AngleTrace, follows: NDArray[np.bool_]) -> None:
        before = trace.state_raw[:1] if self._state is None else self._state
        before = np.concatenate([before, trace.state_raw[:-1]])
        expected = self._filter.step_integer(self.spec, before, trace.accel_count, trace.gyro_count)
        for k in np.flatnonzero(trace.restarted):
            one = slice(k, k + 1)
            expected[one] = self._filter.run_integer(
                self.spec, trace.accel_count[one], trace.gyro_count[one]
            )
        judged = follows | trace.restarted
        wrong = (expected != trace.state_raw).any(axis=1) & judged
        self.checked += int(judged.sum())
        self.mismatches += int(wrong.sum())

    def _follow_float(self, trace: AngleTrace, follows: NDArray[np.bool_]) -> Vector:
        counts = Counts(accel=trace.accel_count, gyro=trace.gyro_count)
        rate, force = to_rate_and_force_g(self._part, self._design.sensor, counts)
        device = trace.state_raw * np.array(self.spec.state_per_unit)
        exact = np.empty_like(device)
        starts = [0, *(int(k) for k in np.flatnonzero(~follows) if k > 0), len(trace)]
        for begin, end in pairwise(starts):
            state = self._float_state
            if trace.restarted[begin]:
                state = None
            elif not follows[begin]:
                exact[begin], state, begin = device[begin], device[begin], begin + 1
            run = slice(begin, end)
            if begin < end:
                exact[run] = self._filter.run_float(self._design, rate[run], force[run], state)
            self._float_state = exact[end - 1]
        axes = len(self.spec.axes)
        residual = wrap_rad(device[:, :axes] - exact[:, :axes])
        judged = np.abs(residual[follows | trace.restarted])
        self._residual_count += judged.size
        self._squares += float(np.vdot(judged, judged))
        self._max = max(self._max, float(judged.max(initial=0.0)))
        return residual

    def report(
        self,
        thresholds: Thresholds,
        *,
        other_digest: str | None = None,
        retuned: bool = False,
    ) -> ValidationReport:
        """Give the verdict on what was taken so far.

        Parameters
        ----------
        thresholds
            What passes.
        other_digest
            Digest of the design that the device runs, if it is another one.
        retuned
            Whether the device runs its design with other parameters: set, calibrated or stored.
        """
        rms = math.sqrt(self._squares / self._residual_count) if self._residual_count else None
        reasons = self._reasons(thresholds, rms)
        if other_digest is not None:
            reasons = (f"the device runs design {other_digest}",)
        elif retuned:
            reasons = (
                "the device runs its design with other parameters, set over the link, calibrated "
                "or stored; PREFLIGHT_STORAGE with 2 gives it the design's again",
            )
        return ValidationReport(
            samples=self.samples,
            checked=self.checked,
            lost=self.lost,
            mismatches=self.mismatches,
            rms_rad=rms,
            max_rad=self._max if self._residual_count else None,
            digest_ok=other_digest is None,
            verdict="refused" if other_digest or retuned else "fail" if reasons else "pass",
            reasons=reasons,
        )

    def _reasons(self, thresholds: Thresholds, rms: float | None) -> tuple[str, ...]:
        reasons = []
        if not self.checked:
            reasons.append("no step could be checked")
        if self.mismatches:
            reasons.append(
                f"{self.mismatches} of {self.checked} steps differ from the integer model"
            )
        if rms is not None and rms * DEG_PER_RAD > thresholds.max_rms_deg:
            reasons.append(
                f"residual {rms * DEG_PER_RAD:.6f} deg rms exceeds {thresholds.max_rms_deg:g} deg"
            )
        if self.lost > thresholds.max_lost_share * (self.samples + self.lost):
            reasons.append(f"{self.lost} of {self.samples + self.lost} samples were lost")
        return tuple(reasons)
