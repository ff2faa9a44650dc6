"""What the user decides about a tuning."""

from dataclasses import dataclass, field
from typing import Literal

from hostkit.errors import HostkitError
from hostkit.mounting import Mounting
from hostkit.provenance import CalibrationRecord
from hostkit.records import AxisChoice, Objective, SensorConfig, TiltMethod
from hostkit.tuning.dimension import FixedParameter, FreeName, SearchRange

Precision = Literal["float64", "float32"]
PRECISIONS: tuple[Precision, ...] = ("float64", "float32")

AUTO = "auto"
"""Optimiser that is chosen by the number of parameters."""

PARTICLES, ITERATIONS = 20, 100
"""Swarm of the paper."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TuningOptions:
    """What the user decides about a tuning.

    Attributes
    ----------
    free, fixed, ranges
        Parameters to search (empty: those that the filter is tuned by), parameters that are set,
        and ranges in place of the usual ones.
    optimiser
        Name of a rule, or ``auto``: grid and Brent for one parameter, QPSO for several.
    particles, iterations
        Size of the swarm and number of its moves.
    restarts
        Swarms with seeds of their own, of which the best is kept.
    jobs
        Threads over recordings and restarts.
    precision
        Of the search: float32 takes half the memory and time and is good to four digits.
    sensor
        Configuration of the sensor; by default from the recordings.
    calibration
        Of the sensor; its terms are fixed, and the design keeps it.
    held_out
        Whether recordings are left out in turn, for an honest figure.
    resamples
        Size of the bootstrap that gives the intervals; 0 for none.
    """

    filter: str = "complementary"
    axes: AxisChoice = "both"
    mounting: Mounting = field(default_factory=Mounting)
    tilt: TiltMethod = "atan2"
    objective: Objective = "rmse"
    free: tuple[FreeName, ...] = ()
    fixed: tuple[FixedParameter, ...] = ()
    ranges: tuple[SearchRange, ...] = ()
    optimiser: str = AUTO
    particles: int = PARTICLES
    iterations: int = ITERATIONS
    restarts: int = 1
    seed: int = 1
    jobs: int = 1
    precision: Precision = "float64"
    sensor: SensorConfig | None = None
    calibration: CalibrationRecord | None = None
    held_out: bool = True
    resamples: int = 40

    def __post_init__(self) -> None:
        """Refuse counts that are not possible."""
        for name, least in (("restarts", 1), ("jobs", 1), ("resamples", 0), ("seed", 0)):
            if getattr(self, name) < least:
                raise HostkitError(f"{name} = {getattr(self, name)}; it must be at least {least}")
