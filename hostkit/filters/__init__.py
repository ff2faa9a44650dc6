"""Filters: one module each with float model, lowering and integer model, and their registry."""

from hostkit.filters import complementary
from hostkit.filters.filter import Filter
from hostkit.registry import Registry

FILTERS: Registry[Filter] = Registry(
    "filter",
    (
        Filter(
            name="complementary",
            lower=complementary.lower,
            run_float=complementary.run_float,
            run_integer=complementary.run_integer,
            step_integer=complementary.step_integer,
        ),
    ),
)
