"""What a filter is to the rest of hostkit: its models, its lowering, what it says of itself."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Generic, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from hostkit.filters.core import FilterCore
from hostkit.filters.sensor_terms import Calibrated, take_no_terms
from hostkit.provenance import CalibrationTerm
from hostkit.records import FilterDesign
from hostkit.spec import FixedPointSpec

Vector = NDArray[np.float64]
IntArray = NDArray[np.int64]
Weights = NDArray[np.complex128]

SpecT = TypeVar("SpecT", bound=FixedPointSpec)
SpecOfT = TypeVar("SpecOfT", bound=FixedPointSpec, contravariant=True)


class RunFloat(Protocol):
    """The float model."""

    def __call__(
        self,
        design: FilterDesign,
        rate_rad_s: Vector,
        force_g: Vector,
        start: Vector | None = None,
    ) -> Vector:
        """Run it.

        Parameters
        ----------
        rate_rad_s, force_g
            Angular rate and specific force (in g) in sensor axes, each of shape ``(N, 3)``.
        start
            State before the first sample, shape ``(S,)``; without it the first sample loads.

        Returns
        -------
        numpy.ndarray
            States, shape ``(N, S)``, the angles in rad and the hidden words in their units.
        """


class RunInteger(Protocol[SpecOfT]):
    """The integer model: what the generated C and VHDL compute, bit for bit."""

    def __call__(
        self,
        spec: SpecOfT,
        accel_count: IntArray,
        gyro_count: IntArray,
        start: IntArray | None = None,
    ) -> IntArray:
        """Run it.

        Parameters
        ----------
        accel_count, gyro_count
            Counts in sensor axes, each of shape ``(N, 3)``.
        start
            State before the first sample, shape ``(S,)``; without it the first sample loads. It may
            be what a stranger told: whatever its words are, no step takes long or fails.

        Returns
        -------
        numpy.ndarray
            States, shape ``(N, S)``.
        """


@dataclass(frozen=True, slots=True, kw_only=True)
class Fact:
    """A number of a design that people want to read.

    Attributes
    ----------
    name
        Key of the number in documents; it ends with its unit.
    label, note
        What people call it, and what it is.
    unit
        Unit on the screen; empty for a plain number.
    """

    name: str
    label: str
    value: float
    unit: str = ""
    note: str = ""

    def text(self) -> str:
        """Return the number with its name and unit, as on the screen."""
        return f"{self.label} {self.value:.6g} {self.unit}".rstrip()


@dataclass(frozen=True, slots=True, kw_only=True)
class ParameterView:
    """Another quantity that says the same as a parameter, as a frequency does of a time constant.

    Attributes
    ----------
    name, symbol, unit
        Its key in documents, and what stands beside and behind it on the screen; may be empty.
    terms
        ``(a, b, c, d)`` of ``(a value + b) / (c value + d)``: a form that can be turned around.
    """

    name: str
    symbol: str
    unit: str
    terms: tuple[float, float, float, float]

    def of(self, value: float) -> float | None:
        """Return the quantity for a value of the parameter; None where there is none."""
        a, b, c, d = self.terms
        below = c * value + d
        return None if below == 0.0 else (a * value + b) / below


def no_views(period_s: float) -> tuple[ParameterView, ...]:
    """Return no views."""
    return ()


@dataclass(frozen=True, slots=True, kw_only=True)
class KnownParameter:
    """A parameter that devices of a filter may have.

    Attributes
    ----------
    name, unit
        Its name on the link, and the unit of its value.
    lowest, highest
        What a device takes; None where that needs the sample rate of a design.
    symbol, title
        What stands beside its value on the screen, and what it is; may be empty.
    views
        Other quantities that say the same, for a sample period (s); the first one may be typed
        instead of the parameter.
    relative_step
        Size of a step of the values that a device keeps, relative to them.
    """

    name: str
    unit: str
    lowest: float | None = None
    highest: float | None = None
    symbol: str = ""
    title: str = ""
    views: Callable[[float], tuple[ParameterView, ...]] = no_views
    relative_step: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class DeviceParameter:
    """A parameter of the filter as a device of a design has it.

    Attributes
    ----------
    name, unit
        Its name on the link, and the unit of its value.
    design_value
        What a device tells that nothing was set on.
    lowest, highest
        What a device takes.
    """

    name: str
    unit: str
    design_value: float
    lowest: float
    highest: float


@dataclass(frozen=True, slots=True, kw_only=True)
class RunTime:
    """The parameters that a running device can change.

    Attributes
    ----------
    known
        Those that some design of the filter has.
    parameters
        Those that a design has, in the order of the device.
    with_told
        The design that a device runs which tells these values, by their names on the link. A value
        that the device tells of the design itself leaves the design's own.
    """

    known: tuple[KnownParameter, ...]
    parameters: Callable[[FilterDesign], tuple[DeviceParameter, ...]]
    with_told: Callable[[FilterDesign, Mapping[str, float]], FilterDesign]


@dataclass(frozen=True, slots=True, kw_only=True)
class SettingWord:
    """A setting that the registers of an FPGA can change while it runs.

    Attributes
    ----------
    name
        Element of the VHDL record ``hk_settings_t``.
    title
        What one unit of the word is.
    raw
        The word of the design; None where the design does not have the setting.
    width, signed
        Format of the word.
    unit
        Unit of the value that `to_raw` takes and `to_value` gives.
    to_raw, to_value
        From a value to the word, not yet rounded, and back.
    """

    name: str
    title: str
    raw: int | None
    width: int
    signed: bool
    unit: str
    to_raw: Callable[[float], float]
    to_value: Callable[[int], float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Filter(Generic[SpecT]):
    """One filter: all that the rest of hostkit knows of it.

    Models take and give states, one row a sample: first the angles of the design's axes, then the
    hidden words that the spec names.

    Attributes
    ----------
    name, title
        Its name in designs, and for a person.
    lower
        From a design to integers.
    run_float, run_integer
        The models, from a state or from the first sample.
    step_integer
        One step from each of N states, independently of each other.
    run_time
        What a running device can change.
    facts
        What people want to read of a design.
    context
        What templates see as ``filter``.
    response
        How a design weighs specific force and angular rate over frequency: two arrays of complex
        numbers of shape ``(N,)`` for N frequencies in Hz.
    setting_words
        What the registers of an FPGA can change, in the order of ``hk_settings_t``.
    core
        Its VHDL core; None where there is none.
    calibrated
        A design with what it has a place for of the terms of a calibration.
    """

    name: str
    title: str
    lower: Callable[[FilterDesign], SpecT]
    run_float: RunFloat
    run_integer: RunInteger[SpecT]
    step_integer: Callable[[SpecT, IntArray, IntArray, IntArray], IntArray]
    run_time: RunTime
    facts: Callable[[FilterDesign], tuple[Fact, ...]]
    response: Callable[[FilterDesign, Vector], tuple[Weights, Weights]]
    context: Callable[[FilterDesign, SpecT], object]
    setting_words: Callable[[FilterDesign, SpecT], tuple[SettingWord, ...]]
    core: FilterCore[SpecT] | None = None
    calibrated: Callable[[FilterDesign, tuple[CalibrationTerm, ...]], Calibrated] = take_no_terms
