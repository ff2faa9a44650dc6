"""Filters: one package each with float model, lowering and integer model, and their registry."""

from typing import Any

from hostkit.filters.complementary import COMPLEMENTARY
from hostkit.filters.filter import Filter
from hostkit.filters.observer import OBSERVER
from hostkit.registry import Registry

FILTERS: Registry[Filter[Any]] = Registry("filter", (COMPLEMENTARY, OBSERVER))
