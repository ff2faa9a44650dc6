"""What people want to read of a design of the complementary filter."""

from hostkit.filters.complementary.parameters import crossover_hz, tau_from_eta
from hostkit.filters.filter import Fact
from hostkit.records import FilterDesign


def facts(design: FilterDesign) -> tuple[Fact, ...]:
    """Return eta and what it means at the sample rate.

    Raises
    ------
    DesignError
        If the design has no eta.
    """
    eta, period_s = design.parameter("eta"), design.period_s
    return (
        Fact(name="eta", label="weight of the rate", value=eta),
        Fact(name="tau_s", label="time constant", value=tau_from_eta(eta, period_s), unit="s"),
        Fact(name="crossover_hz", label="crossover", value=crossover_hz(eta, period_s), unit="Hz"),
    )
