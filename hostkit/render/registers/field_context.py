"""What templates see of a field of a register, and the texts that say its access."""

from dataclasses import dataclass

from hostkit.render.registers.records import WORD_BITS, Field, Register

ACCESS_TEXTS = {
    "ro": "read only",
    "rw": "read, write",
    "w1c": "sticky, 1 clears",
    "pulse": "1 acts, reads 0",
    "pop": "a read takes it",
}
RDL_ACCESS = {
    "ro": ("sw = r", "hw = w"),
    "rw": ("sw = rw", "hw = r"),
    "w1c": ("sw = rw", "onwrite = woclr", "hw = na", "hwset"),
    "pulse": ("sw = w", "hw = r", "singlepulse"),
    "pop": ("sw = r", "hw = w", "swacc"),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class FieldContext:
    """A field as the languages write it.

    Attributes
    ----------
    macro
        Its name with that of the register, for C.
    bits, slice
        Its bits, for people and as the index of a VHDL vector.
    read
        VHDL of what a read shows, of the width of the slice; empty where it reads 0.
    """

    name: str
    macro: str
    description: str
    access: str
    element: str
    kind: str
    low: int
    high: int
    width: int
    bits: str
    slice: str
    mask: int
    reset: int
    present: bool
    read: str
    properties: tuple[str, ...]


def field_context(register: Register, field: Field) -> FieldContext:
    """Lay out one field of a register."""
    return FieldContext(
        name=field.name,
        macro=f"{register.name}_{field.name}",
        description=field.description,
        access=ACCESS_TEXTS[field.access],
        element=field.element,
        kind=field.kind,
        low=field.low,
        high=field.high,
        width=field.width,
        bits=str(field.low) if field.width == 1 else f"{field.high}:{field.low}",
        slice=_slice(field),
        mask=field.mask,
        reset=field.reset,
        present=field.present,
        read=_read(field) if field.readable else "",
        properties=_properties(field),
    )


def _slice(field: Field) -> str:
    """Return the bits that a read sets: a number of less than a word is extended by its sign."""
    if field.source == "setting":
        return f"{WORD_BITS - 1} downto 0"
    return str(field.low) if field.width == 1 else f"{field.high} downto {field.low}"


def _read(field: Field) -> str:
    if field.source == "constant":
        quote = "'" if field.width == 1 else '"'
        return f"{quote}{field.reset:0{field.width}b}{quote}" if field.reset else ""
    if field.source == "setting":
        return f"std_logic_vector(resize({field.element}_r, {WORD_BITS}))"
    if field.source == "decoder" or field.latched_by:
        name = f"{field.element}_r"
    else:
        name = f"from_core.{field.element}{_part(field)}"
    return f"std_logic_vector({name})" if field.kind != "bits" else name


def _part(field: Field) -> str:
    """Return the index of the part of a hardware element that a word takes."""
    if field.kind != "unsigned" or field.width < WORD_BITS:
        return ""
    return f"({field.element_low + field.width - 1} downto {field.element_low})"


def _properties(field: Field) -> tuple[str, ...]:
    if field.source == "constant" or not field.present:
        return ("sw = r", "hw = na", f"reset = {field.reset}")
    own = RDL_ACCESS[field.access]
    return own if field.access in ("ro", "pop") else (*own, f"reset = {field.reset}")
