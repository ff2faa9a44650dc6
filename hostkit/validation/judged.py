"""What a validator says of each sample."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.records import read_only

Vector = NDArray[np.float64]
BoolArray = NDArray[np.bool_]


@dataclass(frozen=True, slots=True, kw_only=True)
class Judged:
    """Samples in their order beside their models; late and repeated ones are left out.

    Attributes
    ----------
    time_us
        Device time, shape ``(N,)``.
    device_rad, model_rad, residual_rad
        Angles of the device and of the float model, and the wrap-safe difference, shape
        ``(N, A)``; model and residual are NaN where the step could not be followed.
    mismatch
        True where the step was checked and is wrong, shape ``(N,)``.
    begins
        True where a sample does not follow the one before it, shape ``(N,)``.
    """

    time_us: NDArray[np.int64]
    device_rad: Vector
    model_rad: Vector
    residual_rad: Vector
    mismatch: BoolArray
    begins: BoolArray

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        read_only(self.time_us)
        for array in (self.device_rad, self.model_rad, self.residual_rad):
            read_only(array)
        read_only(self.mismatch)
        read_only(self.begins)

    def __len__(self) -> int:
        return len(self.time_us)
