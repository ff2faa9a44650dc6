"""The complementary filter of one or two tilt axes."""

from hostkit.filters.complementary.float_model import run_float
from hostkit.filters.complementary.gate import force_gate
from hostkit.filters.complementary.integer_model import run_integer, step_integer
from hostkit.filters.complementary.lowering import LEAST_FORCE_G, lower
from hostkit.filters.complementary.parameters import (
    BIAS_LIMIT_RAD_S,
    BY_NAME,
    KINDS,
    ParameterKind,
    Settings,
    crossover_hz,
    eta_from_tau,
    parameter,
    parameters,
    settings,
    tau_from_eta,
)
from hostkit.filters.complementary.run_time import (
    RUN_TIME,
    RunTimeParameter,
    limits,
    told_by_device,
    with_told,
)
from hostkit.filters.complementary.tilt import RATE_AXIS, measured_tilt_rad, measured_tilt_raw

__all__ = [
    "BIAS_LIMIT_RAD_S",
    "BY_NAME",
    "KINDS",
    "LEAST_FORCE_G",
    "RATE_AXIS",
    "RUN_TIME",
    "ParameterKind",
    "RunTimeParameter",
    "Settings",
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
