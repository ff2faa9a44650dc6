"""Which parameters a device uses: those of its design, or those that it told."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from hostkit.errors import HostkitError
from hostkit.filters import FILTERS
from hostkit.filters.filter import DeviceParameter
from hostkit.records import FilterDesign, RetunedParameter
from hostkit.spec import FixedPointSpec

AGREEING_STEPS = 50
"""Right steps after which no change of a parameter can have been missed."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Model:
    """A design and its integers: what the samples are computed with."""

    design: FilterDesign
    spec: FixedPointSpec


def device_parameters(design: FilterDesign) -> tuple[DeviceParameter, ...]:
    """Return the parameters that a device of a design has for its filter."""
    return FILTERS[design.filter].run_time.parameters(design)


class Retuning:
    """Keeps what a device told, and makes the model of it when a sample needs it.

    Attributes
    ----------
    designed
        The model of the design itself.
    doubted
        Whether a frame was lost that may have told of a change.
    """

    def __init__(self, design: FilterDesign) -> None:
        self.designed = Model(design=design, spec=FILTERS[design.filter].lower(design))
        self.parameters = {p.name: p for p in device_parameters(design)}
        self._told: dict[str, float] = {}
        self._model: Model | None = None
        self._before: dict[str, float] = {}
        self.doubted = False
        self._agreed = 0
        self.drop_withheld()

    def told(self, name: str, value: float) -> None:
        """Take a value that the device told; what is no parameter of the filter is passed over."""
        if name in self.parameters and self._told.get(name) != value:
            self._told[name] = value
            self._model = None

    def forget(self) -> None:
        """Trust nothing that was told: the device may have started anew since."""
        self._told.clear()
        self._model = None
        self.drop_withheld()

    def is_designed(self) -> None:
        """Take a sample that was made with the design's own parameters: all of them are known."""
        if self._model is None and self._told and not self.untold and not self.differences():
            return
        self._told = {name: own.design_value for name, own in self.parameters.items()}
        self._model, self.doubted = None, False
        self.drop_withheld()

    @property
    def untold(self) -> tuple[str, ...]:
        """Parameters whose value is not known, or is none that a device can have."""
        return tuple(
            name
            for name, own in self.parameters.items()
            if not own.lowest <= self._told.get(name, math.nan) <= own.highest
        )

    def retuned_model(self) -> Model | None:
        """Return the model with what was told; None while something is not known."""
        if self._model is None and not self.untold:
            self._model = self._made() if self.differences() else None
            if self._model is None:
                # A retuned device uses something else than it told: the telling was lost.
                self.forget()
        return self._model

    def _made(self) -> Model | None:
        own = self.designed.design
        filter_ = FILTERS[own.filter]
        try:
            design = filter_.run_time.with_told(own, self._told)
            return Model(design=design, spec=filter_.lower(design))
        except HostkitError:
            return None

    def differences(self) -> tuple[RetunedParameter, ...]:
        """Return what was told and is not the design's."""
        return tuple(
            RetunedParameter(
                name=name,
                design_value=own.design_value,
                device_value=self._told[name],
                unit=own.unit,
            )
            for name, own in self.parameters.items()
            if name in self._told and self._told[name] != own.design_value
        )

    def doubt(self) -> None:
        """Take it that a change may have been missed."""
        self.doubted, self._agreed = True, 0

    def agreed(self, steps: int) -> None:
        """Take steps that were right: after some of them nothing can have changed."""
        self._agreed += steps
        self.doubted &= self._agreed < AGREEING_STEPS

    def withhold(self, wrong: int, checked: int) -> None:
        """Keep steps that were wrong until the device has told all of its parameters again."""
        told = dict(self._told)
        self.forget()
        self._before, self._withheld = told, (wrong, checked)
        self.doubted = False

    def take_withheld(self) -> tuple[int, int]:
        """Return wrong and checked steps that count after all, once everything is told again."""
        if not self._before or self.untold:
            return 0, 0
        found = self._withheld if self._before == self._told else (0, 0)
        self.drop_withheld()
        return found

    def drop_withheld(self) -> None:
        """Count nothing that is withheld."""
        self._before, self._withheld = {}, (0, 0)


def runs(flags: Sequence[bool]) -> list[slice]:
    """Return the stretches of equal flags."""
    if not flags:
        return []
    changes = [k for k in range(1, len(flags)) if flags[k] != flags[k - 1]]
    return [slice(a, b) for a, b in zip([0, *changes], [*changes, len(flags)], strict=True)]
