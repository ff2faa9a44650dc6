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
        Fact(name="eta", label="eta", value=eta, note="weight of the integrated rate"),
        Fact(
            name="tau_s",
            label="tau",
            value=tau_from_eta(eta, period_s),
            unit="s",
            note="time constant",
        ),
        Fact(
            name="crossover_hz",
            label="crossover",
            value=crossover_hz(eta, period_s),
            unit="Hz",
            note="below it force decides, above it rate",
        ),
    )
