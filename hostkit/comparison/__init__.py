"""Comparing hostkit's filters with those of other packages: accuracy and cost."""

from hostkit.comparison.comparison import Comparison, compare
from hostkit.comparison.cost import Cost, cost_of, costs
from hostkit.comparison.document import to_document
from hostkit.comparison.options import BUDGET, CompareOptions
from hostkit.comparison.peers import PEERS, USUAL, chosen_peers
from hostkit.comparison.row import Row

__all__ = [
    "BUDGET",
    "PEERS",
    "USUAL",
    "CompareOptions",
    "Comparison",
    "Cost",
    "Row",
    "chosen_peers",
    "compare",
    "cost_of",
    "costs",
    "to_document",
]
