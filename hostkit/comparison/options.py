"""What the user decides about a comparison."""

from dataclasses import dataclass, field

from hostkit.comparison.peers import USUAL
from hostkit.errors import HostkitError
from hostkit.mounting import Mounting
from hostkit.records import AxisChoice, FilterDesign

BUDGET = 400
"""Settings of a fast filter that are tried."""
LEAST_BUDGET = 40
LEAD_LIMIT_S = 0.05
"""As far as a design of the observer may be told ahead."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CompareOptions:
    """What is compared, and how.

    Attributes
    ----------
    design
        Takes the place of hostkit's filters with their defaults and tuned.
    axes, mounting
        What is scored, where there is no design: one angle, or the inclination.
    peers
        Names of filters, or of packages for all of theirs.
    tune
        Whether peers, and hostkit's filters if there is no design, are also tuned.
    held_out
        Whether tuned filters are scored on recordings that were left out in turn.
    gyro_scale
        Whether the scale of the gyroscope is tuned too, for every filter that is tuned well
        enough: three constants of the sensor, from which most of them gain.
    lead_s
        How far every filter that can is told ahead; None for what the design says, or none.
    calibrated_peers
        Whether peers read what the design's calibration makes of the readings.
    evaluations
        Settings of a fast filter that are tried; slower ones get their share.
    """

    design: FilterDesign | None = None
    axes: AxisChoice = "both"
    mounting: Mounting = field(default_factory=Mounting)
    peers: tuple[str, ...] = USUAL
    tune: bool = True
    held_out: bool = True
    gyro_scale: bool = True
    lead_s: float | None = None
    calibrated_peers: bool = False
    evaluations: int = BUDGET
    seed: int = 1
    jobs: int = 1

    def __post_init__(self) -> None:
        """Refuse what is not possible."""
        if self.evaluations < LEAST_BUDGET:
            raise HostkitError(
                f"evaluations = {self.evaluations}; a search needs at least {LEAST_BUDGET}"
            )
        if self.lead_s is not None and not abs(self.lead_s) <= LEAD_LIMIT_S:
            raise HostkitError(
                f"lead_s = {self.lead_s:g} s is outside [{-LEAD_LIMIT_S:g}, {LEAD_LIMIT_S:g}]"
            )
        if self.calibrated_peers and self.design is None:
            raise HostkitError(
                "calibrated peers read what a design's calibration makes of the readings: "
                "name the design"
            )
