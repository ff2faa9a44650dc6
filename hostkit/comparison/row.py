"""One line of a comparison: a filter with its settings, and its errors."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from hostkit.records import Parameter
from hostkit.tuning import HeldOut

Origin = Literal["hostkit", "peer"]
Settings = Literal["design", "default", "tuned"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """A filter over all recordings.

    Attributes
    ----------
    name, title
        Of the filter.
    settings
        Those of a given design, the filter's own, or those tuned on the same recordings.
    is_offline
        Whether it looks ahead, so that no device can run it.
    is_scaled
        Whether the scale of the gyroscope was tuned with the filter's own parameters.
    lead_s
        How far its angles are told ahead.
    each_rad
        RMSE of every recording, in their order.
    held_out
        For tuned settings the errors while recordings were left out; else None.
    parameters
        The settings.
    evaluations
        How many settings were tried; 0 where nothing was tuned.
    """

    name: str
    title: str
    origin: Origin
    settings: Settings
    is_offline: bool = False
    is_scaled: bool = False
    lead_s: float = 0.0
    each_rad: tuple[float, ...]
    held_out: HeldOut | None = None
    parameters: tuple[Parameter, ...]
    evaluations: int = 0

    @property
    def mean_rad(self) -> float:
        """Mean over recordings; of tuned settings a training figure."""
        return float(np.mean(self.each_rad))

    @property
    def worst_rad(self) -> float:
        """Error of the worst recording."""
        return max(self.each_rad)

    @property
    def honest_mean_rad(self) -> float:
        """Mean on what the settings were not tuned on, as far as that is known."""
        return self.mean_rad if self.held_out is None else self.held_out.rms_rad

    @property
    def honest_worst_rad(self) -> float:
        """Worst of what is scored, on what they were not tuned on as far as that is known."""
        return self.worst_rad if self.held_out is None else float(np.nanmax(self.held_out.each_rad))
