"""Which of hostkit's filters the motion of recordings calls for."""

from dataclasses import dataclass
from typing import Final, Literal

from hostkit.diagnosis.diagnosis import Diagnosis
from hostkit.units import DEG_PER_RAD

FilterName = Literal["complementary", "observer"]

SPATIAL: Final = "needs a three-dimensional filter"


@dataclass(frozen=True, slots=True, kw_only=True)
class Recommendation:
    """A filter, and why.

    Attributes
    ----------
    filter
        Name in the registry of filters.
    reason
        A sentence without its full stop.
    """

    filter: FilterName
    reason: str


def recommended_filter(diagnosis: Diagnosis) -> Recommendation | None:
    """Return the filter that a recording calls for; None where the motion cannot be judged.

    Filters of single angles are taken wherever they suffice: they cost a fraction of the
    three-dimensional one, have one number to tune and are easily understood. On public recordings
    for which they suffice the observer was still nearer by 0.2 to 0.7 deg (docs/choosing.md).
    """
    planarity = diagnosis.planarity
    if planarity.verdict is None:
        return None
    extra_deg = planarity.errors.extra_rad * DEG_PER_RAD
    if planarity.verdict == SPATIAL:
        return Recommendation(
            filter="observer",
            reason=f"rates about other axes would put filters of single angles {extra_deg:.2g} deg "
            "further off, and no eta mends that",
        )
    hold = f"{diagnosis.axes} by itself holds"
    if diagnosis.axes == "both":
        hold = "roll and pitch by themselves hold"
    return Recommendation(
        filter="complementary",
        reason=f"{hold} this motion (other axes add {extra_deg:.2g} deg), at "
        "a fraction of the cost of the observer, which may come a few tenths of a degree nearer",
    )


def recommended_for_all(diagnoses: tuple[Diagnosis, ...]) -> Recommendation | None:
    """Return the filter for recordings together: three dimensions if one calls for them."""
    found = [one for d in diagnoses if (one := recommended_filter(d)) is not None]
    spatial = [one for one in found if one.filter == "observer"]
    if spatial and len(found) > 1:
        return Recommendation(
            filter="observer",
            reason=f"{len(spatial)} of {len(found)} recordings need three dimensions: "
            f"{spatial[0].reason}",
        )
    return next(iter(spatial or found), None)
