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
        Fact(name="kt_rad_m", label="tilt gain", value=own.kt_rad_m, unit="rad/m"),
        Fact(name="kv_per_s", label="decay of the velocity", value=own.kv_per_s, unit="1/s"),
        Fact(name="kb_per_s", label="bias gain", value=own.kb_per_s, unit="1/s"),
        Fact(name="tau_s", label="time constant", value=tau_s, unit="s"),
    )
