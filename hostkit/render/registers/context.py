"""What templates see of the registers: names, literals and expressions ready to be placed."""

from collections.abc import Iterable
from dataclasses import dataclass

from hostkit.render.registers.field_context import FieldContext, field_context
from hostkit.render.registers.records import WORD_BITS, WORD_BYTES, Register, RegisterMap

QUARTER_BYTES = 64


@dataclass(frozen=True, slots=True, kw_only=True)
class RegisterContext:
    """A register as the languages write it; `constant` is its word address in VHDL."""

    name: str
    anchor: str
    constant: str
    description: str
    address: int
    word: int
    reset: int
    writable: bool
    present: bool
    fields: tuple[FieldContext, ...]
    shown: tuple[FieldContext, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class SettingContext:
    """A setting: the element of the record, its type and its highest bit."""

    constant: str
    element: str
    kind: str
    top: int
    present: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class NarrowSettings:
    """Settings of one kind of less than a word."""

    width: int
    top: int
    kind: str
    registers: tuple[SettingContext, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class ElementContext:
    """One element of the record of what comes from the core."""

    name: str
    type: str


@dataclass(frozen=True, slots=True, kw_only=True)
class WordRange:
    """Neighbouring words, first and last included."""

    first: int
    last: int


@dataclass(frozen=True, slots=True, kw_only=True)
class QuarterContext:
    """Registers of one quarter of the address space that show anything but 0."""

    number: int
    registers: tuple[RegisterContext, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class RegistersContext:
    """The register map for templates.

    Attributes
    ----------
    inputs
        What comes from the core.
    settings, events
        Those that the design has, and the fields of EVENTS.
    all_settings
        With those that it lacks.
    narrow
        Present settings of less than a word, by kind.
    last_setting
        Index of the last of all settings.
    known, written
        Words that exist, and those that a write may go to.
    """

    registers: tuple[RegisterContext, ...]
    quarters: tuple[QuarterContext, ...]
    inputs: tuple[ElementContext, ...]
    all_settings: tuple[SettingContext, ...]
    settings: tuple[SettingContext, ...]
    narrow: tuple[NarrowSettings, ...]
    events: tuple[FieldContext, ...]
    last_setting: int
    setting_words: WordRange
    known: tuple[WordRange, ...]
    written: tuple[WordRange, ...]
    address_bits: int = 8


def registers_context(registers: RegisterMap) -> RegistersContext:
    """Lay out a map."""
    laid = tuple(_register(register) for register in registers.registers)
    words = [r for r in registers.registers if r.fields[0].source == "setting"]
    settings = tuple(_setting(register) for register in words)
    return RegistersContext(
        registers=laid,
        quarters=tuple(_quarter(number, laid) for number in range(4)),
        inputs=_inputs(registers),
        all_settings=settings,
        settings=tuple(s for s in settings if s.present),
        narrow=_narrow(settings),
        events=next(r.fields for r in laid if r.name == "EVENTS"),
        last_setting=len(settings) - 1,
        setting_words=_ranges(words)[0],
        known=_ranges(registers.registers),
        written=_ranges([r for r in registers.registers if r.writable]),
    )


def _quarter(number: int, registers: tuple[RegisterContext, ...]) -> QuarterContext:
    return QuarterContext(
        number=number,
        registers=tuple(r for r in registers if r.shown and r.address // QUARTER_BYTES == number),
    )


def _setting(register: Register) -> SettingContext:
    field = register.fields[0]
    return SettingContext(
        constant=_constant(register),
        element=field.element,
        kind=field.kind,
        top=field.high,
        present=field.present,
    )


def _narrow(settings: tuple[SettingContext, ...]) -> tuple[NarrowSettings, ...]:
    few = [s for s in settings if s.present and s.top < WORD_BITS - 1]
    return tuple(
        NarrowSettings(
            width=top + 1,
            top=top,
            kind=kind,
            registers=tuple(s for s in few if (s.kind, s.top) == (kind, top)),
        )
        for kind, top in sorted({(s.kind, s.top) for s in few})
    )


def _constant(register: Register) -> str:
    return f"{register.name.lower()}_word_c"


def _register(register: Register) -> RegisterContext:
    fields = tuple(field_context(register, field) for field in register.fields)
    return RegisterContext(
        name=register.name,
        anchor=register.name.lower(),
        constant=_constant(register),
        description=register.description,
        address=register.address,
        word=register.address // WORD_BYTES,
        reset=register.reset,
        writable=register.writable,
        present=register.present,
        fields=fields,
        shown=tuple(field for field in fields if field.read),
    )


def _inputs(registers: RegisterMap) -> tuple[ElementContext, ...]:
    """Return the elements by the order of their fields; one in two words has the width of both."""
    width: dict[str, int] = {}
    kinds: dict[str, str] = {}
    for register in registers.registers:
        for field in register.fields:
            if field.source == "core" or field.access == "w1c":
                needed = field.element_low + field.width
                width[field.element] = max(width.get(field.element, 0), needed)
                kinds[field.element] = field.kind
    return tuple(
        ElementContext(name=name, type=_vhdl_type(kinds[name], bits))
        for name, bits in width.items()
    )


def _vhdl_type(kind: str, width: int) -> str:
    if width == 1:
        return "std_logic"
    name = "std_logic_vector" if kind == "bits" else kind
    return f"{name}({width - 1} downto 0)"


def _ranges(registers: Iterable[Register]) -> tuple[WordRange, ...]:
    words = [register.address // WORD_BYTES for register in registers]
    firsts = [word for word in words if word - 1 not in words]
    lasts = [word for word in words if word + 1 not in words]
    return tuple(WordRange(first=a, last=b) for a, b in zip(firsts, lasts, strict=True))
