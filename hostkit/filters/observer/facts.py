"""What people want to read of a design of the observer."""

import math

from hostkit.filters.filter import Fact
from hostkit.filters.observer.settings import settings
from hostkit.records import FilterDesign
from hostkit.units import STANDARD_GRAVITY_M_S2


def facts(design: FilterDesign) -> tuple[Fact, ...]:
    """Return the gains, and the time constant that the tilt gain makes: 1 / sqrt(kt g).

    Raises
    ------
    DesignError
        If a parameter is not possible.
    """
    own = settings(design)
    tau_s = 1.0 / math.sqrt(own.kt_rad_m * STANDARD_GRAVITY_M_S2)
    return (
        Fact(
            name="kt_rad_m",
            label="kt",
            value=own.kt_rad_m,
            unit="rad/m",
            note="rate of correction per velocity",
        ),
        Fact(
            name="kv_per_s",
            label="kv",
            value=own.kv_per_s,
            unit="1/s",
            note="decay of the velocity",
        ),
        Fact(
            name="kb_per_s",
            label="kb",
            value=own.kb_per_s,
            unit="1/s",
            note="bias per correction",
        ),
        Fact(
            name="tau_s",
            label="tau",
            value=tau_s,
            unit="s",
            note="time constant, 1 / sqrt(kt g)",
        ),
    )
