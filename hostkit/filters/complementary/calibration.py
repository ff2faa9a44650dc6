"""What the complementary filter takes of a calibration: bias and scale of its own rates.

A sensor axis k that the mounting makes a body axis with sign c reads r; its true rate is
``(1 + s) (r - b_k)``. The filter's is ``(1 + s) c r - b``, hence ``b = c (1 + s) b_k``. There is no
place for the terms of the accelerometer.
"""

from hostkit.filters.complementary.parameters import BY_NAME, parameter
from hostkit.filters.complementary.tilt import RATE_AXIS
from hostkit.filters.sensor_terms import Calibrated, with_parameters
from hostkit.provenance import CalibrationTerm, TermKind
from hostkit.records import AXES, Axis, FilterDesign, Parameter


def calibrated(design: FilterDesign, terms: tuple[CalibrationTerm, ...]) -> Calibrated:
    """Return the design with the bias and the scale of each axis that it integrates.

    Parameters
    ----------
    design
        A design of the complementary filter.
    terms
        What a calibration found, in sensor axes.
    """
    new: list[Parameter] = []
    taken: list[str] = []
    for axis in AXES[design.axes]:
        body = RATE_AXIS[axis]
        sensor, sign = design.mounting.source[body], design.mounting.sign[body]
        bias = _term(terms, "gyro_bias", sensor)
        scale = _term(terms, "gyro_scale", sensor)
        if scale is not None:
            new.append(parameter("gyro_scale", scale.value, axis))
            taken.append(scale.name)
        if bias is not None:
            factor = 1.0 + (_present_scale(design, axis) if scale is None else scale.value)
            new.append(parameter("gyro_bias", sign * factor * bias.value, axis))
            taken.append(bias.name)
    return Calibrated(design=with_parameters(design, tuple(new)), taken=tuple(taken))


def _term(
    terms: tuple[CalibrationTerm, ...], kind: TermKind, sensor_axis: int
) -> CalibrationTerm | None:
    found = (term for term in terms if term.kind == kind and term.axis == sensor_axis)
    return next(found, None)


def _present_scale(design: FilterDesign, axis: Axis) -> float:
    key = BY_NAME["gyro_scale"].key(axis)
    return next((p.value for p in design.parameters if p.name == key), 0.0)
