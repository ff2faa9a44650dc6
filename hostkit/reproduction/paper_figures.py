"""Figures 4 to 9 of the paper, drawn anew from simulated data."""

import numpy as np
from numpy.typing import NDArray

from hostkit.reproduction.errors import Groups, errors_rad, eta_of, first_samples
from hostkit.reproduction.frequency import SensorErrorSweep
from hostkit.reproduction.results import FigureResult, Series, in_words
from hostkit.reproduction.study import (
    PAPER_PERIOD_S,
    PSO_TAU_S,
    QPSO_TAU_S,
    ClassStudy,
    PaperRun,
    Study,
)
from hostkit.reproduction.trials import HIT_RAD

Vector = NDArray[np.float64]

FINAL_SAMPLES = 35
"""Samples of the paper's last test."""

ITERATION, EXCESS = "iteration", "fitness above the optimum, rad"


def paper_figures(study: Study) -> tuple[FigureResult, ...]:
    """Return the figures that can be drawn; 1 to 3 are drawings of the set-up."""
    return (
        _figure_4(study.by_cycles, "4a", "over two cycles of each frequency"),
        _figure_4(study.by_time, "4b", "over 30 s of each frequency"),
        _figure_5(study.fast),
        _figure_6(study.slow),
        _figure_7(study.slow),
        *_figures_8_and_9(study.slow),
    )


def final_errors_rad(study: ClassStudy) -> tuple[Vector, Vector]:
    """Return the errors of the paper's two filters on the first 35 samples of the first log."""
    group = first_samples(study.material.logs, FINAL_SAMPLES).one(0)
    one, other = (_errors(group, tau_s) for tau_s in (QPSO_TAU_S, PSO_TAU_S))
    return one, other


def rms_rad(error: Vector) -> float:
    """Return the root mean square of an error."""
    return float(np.sqrt(np.mean(error * error)))


def _errors(group: Groups, tau_s: float) -> Vector:
    return np.asarray(errors_rad(group, eta_of(np.array([tau_s]), PAPER_PERIOD_S))[0])


def _figure_4(sweep: SensorErrorSweep, name: str, how: str) -> FigureResult:
    frequency, gyro = sweep.frequency_rad_s, sweep.gyro_rad
    lowest = int(np.argmin(gyro))
    return FigureResult(
        name=name,
        title=f"Error of each sensor over frequency, {how}",
        claim=(
            "The accelerometer is good at low frequency and worse as it rises; the gyroscope is "
            "the better the higher the frequency."
        ),
        found=(
            f"The errors cross at {in_words(sweep.crossing_rad_s, 'rad/s')}. The accelerometer's "
            f"goes from {sweep.accel_rad[0]:.2g} to {sweep.accel_rad[-1]:.2g} rad, the gyroscope's "
            f"from {gyro[0]:.2g} to {gyro[-1]:.2g} rad with its least, {gyro[lowest]:.2g} rad, at "
            f"{frequency[lowest]:.2g} rad/s."
        ),
        x_label="angular frequency, rad/s",
        y_label="mean absolute error, rad",
        log_x=True,
        log_y=True,
        series=(
            Series(label="accelerometer", x=frequency, y=sweep.accel_rad),
            Series(label="gyroscope", x=frequency, y=gyro),
        ),
    )


def _figure_5(study: ClassStudy) -> FigureResult:
    logs = study.material.logs
    tilt, measured, rate = logs.tilt_rad[0], logs.measured_tilt_rad[0], logs.rate_rad_s[0]
    whole = first_samples(logs, len(tilt)).one(0)
    gyro = tilt[0] + np.cumsum(rate * logs.period_s) - rate[0] * logs.period_s
    eta = float(eta_of(study.pooled.tau_s[:1], logs.period_s)[0])
    error = errors_rad(whole, np.array([eta]))[0]
    time_s = logs.period_s * np.arange(len(tilt), dtype=np.float64)
    return FigureResult(
        name="5",
        title="Tilt from either sensor and from the filter, sampled every 0.05 s",
        claim=(
            "The accelerometer is noisy with the right trend, the gyroscope smooth but drifting; "
            "the filter has neither fault."
        ),
        found=(
            f"RMSE over 15 s: accelerometer {rms_rad(measured - tilt):.2g} rad, gyroscope "
            f"{rms_rad(gyro - tilt):.2g} rad, filter {rms_rad(error):.2g} rad with eta {eta:.3f}, "
            "the optimum of this log."
        ),
        x_label="time, s",
        y_label="tilt, rad",
        series=(
            Series(label="accelerometer", x=time_s, y=measured),
            Series(label="gyroscope", x=time_s, y=gyro),
            Series(label="filter", x=time_s, y=tilt + error),
            Series(label="truth", x=time_s, y=tilt),
        ),
    )


def _figure_6(study: ClassStudy) -> FigureResult:
    runs = (
        ("QPSO", study.qpso),
        ("PSO, falling weight", study.ldwpso),
        ("PSO, constriction", study.pso),
    )
    found = "; ".join(f"{name} {_course(run)}" for name, run in runs)
    return FigureResult(
        name="6",
        title="Convergence of one tuning: the first group of the first log",
        claim=(
            "QPSO is flat from iteration 11. PSO is flat at 15 and again at 41: trapped in a local "
            "optimum."
        ),
        found=f"In this one run {found}.",
        x_label=ITERATION,
        y_label=EXCESS,
        log_y=True,
        series=tuple(
            Series(label=name, x=np.arange(len(history), dtype=np.float64), y=history)
            for name, run in runs
            for history in (np.maximum(run.trial.excess_history_rad[0, 0, 0], 0.0),)
        ),
    )


def _course(run: PaperRun) -> str:
    excess = run.trial.excess_history_rad[0, 0, 0]
    if excess[-1] > HIT_RAD:
        return (
            f"ends {excess[-1]:.2g} rad above the optimum, at tau {run.trial.tau_s[0, 0, 0]:.3g} s"
        )
    return f"is within 1e-6 rad after {int(np.argmax(excess <= HIT_RAD))} iterations"


def _figure_7(study: ClassStudy) -> FigureResult:
    ours, theirs = study.qpso.trial.rmse_rad, study.ldwpso.trial.rmse_rad
    worse, better = float(np.mean(theirs > ours + HIT_RAD)), float(np.mean(theirs < ours - HIT_RAD))
    number = np.arange(1.0, ours.shape[1] + 1.0)
    return FigureResult(
        name="7",
        title="Test error of the ten groups of the first log, one run each",
        claim="QPSO's error is the lower one.",
        found=(
            f"Over all logs and runs PSO with falling weight is worse in {100 * worse:.0f} % of "
            f"the groups and better in {100 * better:.0f} %; the rest is equal within 1e-6 rad."
        ),
        x_label="group",
        y_label="RMSE of the test samples, rad",
        series=(
            Series(label="QPSO", x=number, y=ours[0, :, 0]),
            Series(label="PSO, falling weight", x=number, y=theirs[0, :, 0]),
        ),
    )


def _figures_8_and_9(study: ClassStudy) -> tuple[FigureResult, FigureResult]:
    tilt = study.material.logs.tilt_rad[0, :FINAL_SAMPLES]
    sample = np.arange(1.0, FINAL_SAMPLES + 1.0)
    labels = ("eta 0.412 (QPSO)", "eta 0.444 (PSO)")
    pairs = tuple(zip(labels, final_errors_rad(study), strict=True))
    sizes = ", ".join(f"{label} {rms_rad(error):.4f} rad" for label, error in pairs)
    outputs = FigureResult(
        name="8",
        title="Both filters on 35 samples",
        claim="The filter follows the true angle; noise and drift are gone.",
        found=f"RMSE: {sizes}.",
        x_label="sample",
        y_label="tilt, rad",
        series=(
            Series(label="truth", x=sample, y=tilt),
            *(Series(label=label, x=sample, y=tilt + error) for label, error in pairs),
        ),
    )
    errors = FigureResult(
        name="9",
        title="Errors of both filters on the same 35 samples",
        claim="QPSO's filter has the smaller error.",
        found=f"RMSE: {sizes}. One log proves nothing either way: see the findings.",
        x_label="sample",
        y_label="error, rad",
        series=tuple(Series(label=label, x=sample, y=error) for label, error in pairs),
    )
    return outputs, errors
