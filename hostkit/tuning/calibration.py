"""Tuning on top of a calibration: its terms are fixed, and the design keeps where they are from."""

from dataclasses import replace

from hostkit.errors import DesignError
from hostkit.filters import FILTERS
from hostkit.records import FilterDesign, SensorConfig
from hostkit.tuning.dimension import FixedParameter, option_name
from hostkit.tuning.options import TuningOptions
from hostkit.tuning.tuner import Tuner
from hostkit.tuning.tuners import TUNERS

NO_SENSOR = SensorConfig(
    part="mpu6050", gyro_full_scale_deg_s=250, accel_full_scale_g=2, low_pass_setting=0
)
"""A calibration is in SI units, so its terms do not depend on the ranges."""


def with_calibration(options: TuningOptions, rate_hz: float) -> TuningOptions:
    """Return options in which the terms of their calibration are fixed.

    What the user fixed stays as it is. A parameter that is calibrated is not searched, unless the
    user named it.

    Raises
    ------
    DesignError
        If the user named one that is calibrated.
    """
    if options.calibration is None:
        return options
    tuner = TUNERS[options.filter]
    named = {one.name for one in options.fixed}
    fixed = tuple(one for one in _fixed(options, tuner, rate_hz) if one.name not in named)
    calibrated = {one.name for one in fixed}
    for name in options.free:
        if name in calibrated:
            raise DesignError(
                f"{option_name(name)} is to be tuned, and the calibration has it: leave it out of "
                "what is free, or do without the calibration"
            )
    free = options.free or tuple(name for name in tuner.free if name not in calibrated | named)
    return replace(options, fixed=(*options.fixed, *fixed), free=free)


def _fixed(options: TuningOptions, tuner: Tuner, rate_hz: float) -> list[FixedParameter]:
    assert options.calibration is not None
    bare = FilterDesign(
        filter=options.filter,
        axes=options.axes,
        tilt=options.tilt,
        mounting=options.mounting,
        rate_hz=rate_hz,
        sensor=options.sensor or NO_SENSOR,
        parameters=(),
    )
    taken = FILTERS[options.filter].calibrated(bare, options.calibration.terms).design
    values = {p.name: p.value for p in taken.parameters}
    return [
        FixedParameter(name=t.name, value=values[key], axis=axis)
        for t in tuner.tunables
        for axis in (t.axes or (None,))
        if (key := tuner.key(t.name, axis)) in values
    ]
