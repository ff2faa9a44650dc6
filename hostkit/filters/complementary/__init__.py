"""The complementary filter of one or two tilt axes."""

from hostkit.filters.complementary.model import (
    LEAST_FORCE_G,
    RATE_AXIS,
    lower,
    measured_tilt_rad,
    measured_tilt_raw,
    run_float,
    run_integer,
    step_integer,
)
from hostkit.filters.complementary.parameters import (
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

__all__ = [
    "BY_NAME",
    "KINDS",
    "LEAST_FORCE_G",
    "RATE_AXIS",
    "ParameterKind",
    "Settings",
    "crossover_hz",
    "eta_from_tau",
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
]
