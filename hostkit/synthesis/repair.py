"""Checks and repairs the Verilog that GHDL 2.0 writes.

Its writer has five known faults. A ``case`` loses its default, a signed shift its sign, a constant
of more than 32 bits becomes a text, and a signal called like an instance and its port is declared
twice: the VHDL avoids these four, and here they are only looked for. A signed product is written as an unsigned one of extended operands, which costs more
multipliers: that one is repaired.
"""

import re
from dataclasses import dataclass

from hostkit.errors import BuildError

_PLACE = re.compile(r"/\* ([\w./-]+\.vhdl?:\d+):\d+ +\*/")
_PRODUCT = re.compile(r"assign (\w+) = (\w+) \* (\w+); // smul")
_MARK = "// smul"
_END = "endmodule\n"
_SIGNED = re.compile(r"assign (\w+) = \{\{\d+\{(\w+)\[\d+\]\}\}, (\w+)\}; // sext")
_UNSIGNED = re.compile(r"assign (\w+) = \{\d+'b0+, \w+\}; +// +uext")
_DECLARED = re.compile(r"^(?:module|  (?:wire|reg)(?: \[[^]]*\])?) (\w+)", re.MULTILINE)
_FAULTS = (
    ("a case without a default", re.compile(r"^\s*case[xz]?\b", re.MULTILINE)),
    ("a signed shift without its sign", re.compile(r"\$signed\([^)]*\) >> ")),
    ("a long constant as a text", re.compile(r'"')),
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Repair:
    """Verilog after the repair.

    Attributes
    ----------
    products
        Signed products found, all of them repaired.
    """

    text: str
    products: int


def repair(text: str) -> Repair:
    """Restore the signed products; :func:`check` refuses what cannot be repaired.

    Raises
    ------
    BuildError
        If a product is neither of two sign-extended nor of two zero-extended operands.
    """
    parts = [_repaired(module) for module in text.split(_END)]
    return Repair(
        text=_END.join(part.text for part in parts), products=sum(part.products for part in parts)
    )


def _repaired(module: str) -> Repair:
    """Repair one module; the names of wires are its own."""
    signed = {name: source for name, bit, source in _SIGNED.findall(module) if bit == source}
    unsigned = set(_UNSIGNED.findall(module))
    repaired = 0
    for product in _PRODUCT.finditer(module):
        result, *operands = product.groups()
        if signed.keys() >= set(operands):
            first, second = (signed[operand] for operand in operands)
            module = module.replace(
                product.group(), f"assign {result} = $signed({first}) * $signed({second});"
            )
            repaired += 1
        elif unsigned >= set(operands):
            module = module.replace(product.group(), product.group().replace(_MARK, "// umul"))
    if _MARK in module:
        place = place_of(module, module.index(_MARK))
        raise BuildError(f"the converted product at {place} cannot be repaired")
    return Repair(text=module, products=repaired)


def check(text: str) -> None:
    """Refuse converted Verilog that holds one of the faults that cannot be repaired.

    Raises
    ------
    BuildError
        Naming the fault and the VHDL line it comes from.
    """
    for fault, pattern in _FAULTS:
        match = pattern.search(text)
        if match is not None:
            raise BuildError(f"GHDL wrote {fault}, at {place_of(text, match.start())}")
    for module in text.split(_END):
        name, *names = _DECLARED.findall(module) or [""]
        twice = sorted({wire for wire in names if names.count(wire) > 1})
        if twice:
            raise BuildError(
                f"GHDL wrote two wires {twice[0]} in {name}: a signal has the name of an instance "
                "and its port"
            )


def place_of(text: str, position: int) -> str:
    """Return the VHDL file and line that a position of the converted Verilog comes from."""
    places = _PLACE.findall(text, 0, position)
    return places[-1] if places else "an unknown place"
