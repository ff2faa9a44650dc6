"""The complementary filter of one or two tilt axes."""

from hostkit.filters.complementary.calibration import calibrated
from hostkit.filters.complementary.context import filter_context
from hostkit.filters.complementary.core import CORE
from hostkit.filters.complementary.facts import facts
from hostkit.filters.complementary.float_model import run_float
from hostkit.filters.complementary.gate import force_gate
from hostkit.filters.complementary.integer_model import run_integer, step_integer
from hostkit.filters.complementary.lowering import LEAST_FORCE_G, lower
from hostkit.filters.complementary.parameters import (
    BIAS_LIMIT_RAD_S,
    BY_NAME,
    crossover_hz,
    eta_from_tau,
    parameter,
    parameters,
    settings,
    tau_from_eta,
)
from hostkit.filters.complementary.response import response
from hostkit.filters.complementary.run_time import (
    RUN_TIME,
    device_parameters,
    known_parameters,
    limits,
    told_by_device,
    with_told,
    with_told_by_name,
)
from hostkit.filters.complementary.setting_words import setting_words
from hostkit.filters.complementary.spec import ComplementarySpec
from hostkit.filters.complementary.tilt import RATE_AXIS, measured_tilt_rad, measured_tilt_raw
from hostkit.filters.filter import Filter, RunTime

__all__ = [
    "BIAS_LIMIT_RAD_S",
    "BY_NAME",
    "COMPLEMENTARY",
    "LEAST_FORCE_G",
    "RATE_AXIS",
    "RUN_TIME",
    "crossover_hz",
    "eta_from_tau",
    "force_gate",
    "limits",
    "lower",
    "measured_tilt_rad",
    "measured_tilt_raw",
    "parameter",
    "parameters",
    "run_float",
    "run_integer",
    "settings",
    "step_integer",
    "tau_from_eta",
    "told_by_device",
    "with_told",
]

COMPLEMENTARY: Filter[ComplementarySpec] = Filter(
    name="complementary",
    title="complementary filter",
    lower=lower,
    run_float=run_float,
    run_integer=run_integer,
    step_integer=step_integer,
    run_time=RunTime(
        known=known_parameters(),
        parameters=device_parameters,
        with_told=with_told_by_name,
    ),
    facts=facts,
    response=response,
    context=filter_context,
    setting_words=setting_words,
    core=CORE,
    calibrated=calibrated,
)
