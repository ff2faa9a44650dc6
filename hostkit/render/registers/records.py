"""A register map by its records, which refuse what hardware or software could not be made of."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final, Literal, get_args

from hostkit.errors import RenderError
from hostkit.identifiers import VERILOG, VHDL, require_identifier

Access = Literal["ro", "rw", "w1c", "pulse", "pop"]
"""Read only; read and write; sticky until 1 is written; acts when 1 is written and reads 0; a read
takes the value away."""
Source = Literal["constant", "core", "setting", "decoder"]
"""Where a field's bits are: nowhere but in the decoder's text, in the core, in the settings that
wait to be committed, or in a flip-flop of the decoder."""
Kind = Literal["bits", "unsigned", "signed"]

WORD_BITS: Final = 32
WORD_BYTES: Final = 4
SPACE_BYTES: Final = 256


@dataclass(frozen=True, slots=True, kw_only=True)
class Field:
    """Bits of a register that belong together.

    Attributes
    ----------
    name, description
        What it is called, and what it says or does.
    low, width
        Its lowest bit and how many it has.
    access, source
        What the bus can do with it, and where its bits are.
    element, element_low
        Name of the hardware behind it and the bit of it at `low`; a constant has none.
    kind
        Bits, or a number, in two's complement if signed.
    reset
        Value after reset, or of a constant, as unsigned bits.
    present
        Whether the design has it; else it reads 0 and is not written.
    latched_by
        Register whose reading keeps what this field then shows.
    """

    name: str
    description: str
    low: int
    width: int
    access: Access = "ro"
    source: Source = "core"
    element: str = ""
    element_low: int = 0
    kind: Kind = "bits"
    reset: int = 0
    present: bool = True
    latched_by: str = ""

    def __post_init__(self) -> None:
        """Refuse names, places and values that no register can have."""
        require_identifier("field", self.name)
        if self.element:
            require_identifier(
                f"element of field {self.name}", self.element, languages=(VHDL, VERILOG)
            )
        if bool(self.element) == (self.source == "constant"):
            raise RenderError(f"field {self.name}: a constant, and only that, has no element")
        for what, value, known in (
            ("access", self.access, Access),
            ("source", self.source, Source),
            ("kind", self.kind, Kind),
        ):
            if value not in get_args(known):
                raise RenderError(
                    f"field {self.name}: {what} = {value!r}; it must be one of: "
                    f"{', '.join(get_args(known))}"
                )
        if self.width < 1 or self.low < 0 or self.high >= WORD_BITS:
            raise RenderError(
                f"field {self.name} = bits {self.high} to {self.low}; it must lie in 31 to 0"
            )
        if not 0 <= self.reset < 2**self.width:
            raise RenderError(
                f"field {self.name}: reset = {self.reset} does not fit {self.width} bits"
            )
        if not self.present and self.reset:
            raise RenderError(f"field {self.name} is not present, so its reset must be 0")

    @property
    def high(self) -> int:
        """Highest bit."""
        return self.low + self.width - 1

    @property
    def mask(self) -> int:
        """Bits of the register that are this field's."""
        return (1 << self.width) - 1 << self.low

    @property
    def readable(self) -> bool:
        """Whether a read shows it; else it reads 0."""
        return self.present and self.access != "pulse"

    @property
    def writable(self) -> bool:
        """Whether the bus may write it, even where the design ignores that."""
        return self.access in ("rw", "w1c", "pulse")


@dataclass(frozen=True, slots=True, kw_only=True)
class Register:
    """One word of the map: its name, its address in bytes and its fields from bit 0 up."""

    name: str
    address: int
    description: str
    fields: tuple[Field, ...]

    def __post_init__(self) -> None:
        """Refuse bad names and places, and fields that meet."""
        require_identifier("register", self.name)
        if self.address % WORD_BYTES or not 0 <= self.address < SPACE_BYTES:
            raise RenderError(
                f"register {self.name} at {self.address}; it must be a multiple of {WORD_BYTES} "
                f"below {SPACE_BYTES}"
            )
        if not self.fields:
            raise RenderError(f"register {self.name} has no fields")
        _require_different(f"field of {self.name}", [field.name for field in self.fields])
        for below, above in zip(self.fields, self.fields[1:], strict=False):
            if above.low <= below.high:
                raise RenderError(
                    f"register {self.name}: field {above.name} must start above bit {below.high}, "
                    f"where {below.name} ends; it starts at {above.low}"
                )

    @property
    def reset(self) -> int:
        """The word that is read after reset, hardware being at 0."""
        return sum(field.reset << field.low for field in self.fields)

    @property
    def writable(self) -> bool:
        """Whether a write is answered without an error."""
        return any(field.writable for field in self.fields)

    @property
    def present(self) -> bool:
        """Whether the design has any of it."""
        return any(field.present for field in self.fields)


@dataclass(frozen=True, slots=True, kw_only=True)
class RegisterMap:
    """Registers by rising address."""

    registers: tuple[Register, ...]

    def __post_init__(self) -> None:
        """Refuse two registers of one name or at one address."""
        _require_different("register", [register.name for register in self.registers])
        for below, above in zip(self.registers, self.registers[1:], strict=False):
            if above.address <= below.address:
                raise RenderError(
                    f"register {above.name} at {above.address} must lie above {below.name} "
                    f"at {below.address}"
                )

    def register(self, name: str) -> Register:
        """Return one register.

        Raises
        ------
        RenderError
            If there is none of that name.
        """
        for register in self.registers:
            if register.name == name:
                return register
        known = ", ".join(register.name for register in self.registers)
        raise RenderError(f"there is no register {name!r}; there are: {known}")


def _require_different(what: str, names: Iterable[str]) -> None:
    seen = set()
    for name in names:
        if name.lower() in seen:
            raise RenderError(f"{what} {name} is there twice; case does not tell names apart")
        seen.add(name.lower())
