"""What becomes of a generated core in a tool for FPGAs.

Conversion, mapping, gate level, place and route.
"""

from hostkit.synthesis.convert import Converted, convert
from hostkit.synthesis.mapping import FAMILIES, Mapped, Resources, map_netlist
from hostkit.synthesis.measure import measure

__all__ = ["FAMILIES", "Converted", "Mapped", "Resources", "convert", "map_netlist", "measure"]
