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
    three-dimensional one, have one number to tune and are easily understood.
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
    angles = {"both": "roll and pitch", "roll": "roll", "pitch": "pitch"}[diagnosis.axes]
    return Recommendation(
        filter="complementary",
        reason=f"{angles} by themselves hold this motion (other axes add {extra_deg:.2g} deg), at a "
        "fraction of the cost of a three-dimensional filter",
    )


def recommended_for_all(diagnoses: tuple[Diagnosis, ...]) -> Recommendation | None:
    """Return the filter for recordings together: if one calls for three dimensions, all get them."""
    found = [one for d in diagnoses if (one := recommended_filter(d)) is not None]
    spatial = [one for one in found if one.filter == "observer"]
    if spatial and len(found) > 1:
        return Recommendation(
            filter="observer",
            reason=f"{len(spatial)} of {len(found)} recordings need three dimensions: "
            f"{spatial[0].reason}",
        )
    return next(iter(spatial or found), None)
