"""The bounded-velocity observer of orientation."""

from hostkit.filters.filter import Filter, RunTime
from hostkit.filters.observer.context import filter_context
from hostkit.filters.observer.core import CORE
from hostkit.filters.observer.facts import facts
from hostkit.filters.observer.float_model import run_float
from hostkit.filters.observer.integer_model import run_integer, step_integer
from hostkit.filters.observer.lowering import lower
from hostkit.filters.observer.parameters import (
    BY_NAME,
    default_parameters,
    parameter,
    parameters,
)
from hostkit.filters.observer.response import response
from hostkit.filters.observer.run_time import (
    RUN_TIME,
    device_limits,
    device_parameters,
    known_parameters,
    told_by_device,
    with_told,
)
from hostkit.filters.observer.setting_words import setting_words
from hostkit.filters.observer.settings import settings
from hostkit.filters.observer.spec import ObserverSpec
from hostkit.filters.sensor_terms import take_sensor_terms

__all__ = [
    "BY_NAME",
    "OBSERVER",
    "RUN_TIME",
    "default_parameters",
    "device_limits",
    "lower",
    "parameter",
    "parameters",
    "response",
    "run_float",
    "run_integer",
    "settings",
    "step_integer",
    "told_by_device",
    "with_told",
]

OBSERVER: Filter[ObserverSpec] = Filter(
    name="observer",
    title="bounded-velocity observer",
    lower=lower,
    run_float=run_float,
    run_integer=run_integer,
    step_integer=step_integer,
    run_time=RunTime(
        known=known_parameters(),
        parameters=device_parameters,
        with_told=with_told,
    ),
    facts=facts,
    response=response,
    context=filter_context,
    setting_words=setting_words,
    core=CORE,
    calibrated=take_sensor_terms,
)
