"""Checks and repairs the Verilog that GHDL 2.0 writes.

Its writer has five known faults. A ``case`` loses its default, a signed shift its sign, and a
constant of more than 32 bits becomes a text: the VHDL avoids these three, and here they are only
looked for. Two are repaired: a signed product is written as an unsigned one of extended operands,
which costs more multipliers, and a signal called like the instance and the port that drive it is
declared twice and driven by itself.
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
_CASE = re.compile(r"^ *case[xz]? .*?^ *endcase", re.MULTILINE | re.DOTALL)
_CHOICE = re.compile(r"^ *(\d+)'b([01]+):", re.MULTILINE)
_FAULTS = (
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
    """Restore signed products and signals that are declared twice.

    Raises
    ------
    BuildError
        If a product is neither of two sign-extended nor of two zero-extended operands, or two
        wires of one name are not the same.
    """
    parts = [_repaired(module) for module in text.split(_END)]
    return Repair(
        text=_END.join(part.text for part in parts), products=sum(part.products for part in parts)
    )


def _repaired(module: str) -> Repair:
    """Repair one module; the names of wires are its own."""
    module = _declared_once(module)
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


def _declared_once(module: str) -> str:
    """Join a signal with the output of the same name that drives it."""
    name, *wires = _DECLARED.findall(module) or [""]
    for wire in sorted({wire for wire in wires if wires.count(wire) > 1}):
        itself = f"  assign {wire} = {wire}; // (signal)\n"
        if wires.count(wire) != 2 or module.count(itself) != 1:
            raise BuildError(f"GHDL wrote two wires {wire} in {name}, and one is not the other")
        line = next(m.group() for m in _DECLARED.finditer(module) if m.group(1) == wire)
        module = module.replace(itself, "").replace(f"{line};\n", "", 1)
    return module


def check(text: str) -> None:
    """Refuse converted Verilog that holds one of the faults that cannot be repaired.

    Raises
    ------
    BuildError
        Naming the fault and the VHDL line it comes from.
    """
    for case in _CASE.finditer(text):
        if not _is_full(case.group()):
            place = place_of(text, case.start())
            raise BuildError(f"GHDL wrote a case without a default, at {place}")
    for fault, pattern in _FAULTS:
        match = pattern.search(text)
        if match is not None:
            raise BuildError(f"GHDL wrote {fault}, at {place_of(text, match.start())}")


def _is_full(case: str) -> bool:
    """Say whether a case has every choice, as one that reads a vector by an index."""
    choices = {(int(width), digits) for width, digits in _CHOICE.findall(case)}
    widths = {width for width, _ in choices}
    return len(widths) == 1 and len(choices) == 2 ** widths.pop()


def place_of(text: str, position: int) -> str:
    """Return the VHDL file and line that a position of the converted Verilog comes from."""
    places = _PLACE.findall(text, 0, position)
    return places[-1] if places else "an unknown place"
