"""What the registers of the FPGA system are: the map of a design."""

from typing import Final

from hostkit.filters.core import CoreFacts
from hostkit.records import Axis, FilterDesign
from hostkit.render.core_context import core_facts
from hostkit.render.fpga_options import DEFAULT_FPGA_OPTIONS, FpgaOptions
from hostkit.render.registers.constants import constant_registers
from hostkit.render.registers.records import WORD_BYTES, Access, Field, Kind, Register, RegisterMap
from hostkit.render.registers.setting_registers import setting_registers
from hostkit.spec import FixedPointSpec

CONTROL_ADDRESS: Final = 0x24
SAMPLE_ADDRESS: Final = 0x80
SAMPLE_COUNTS_ADDRESS: Final = 0x9C
COUNTS_ADDRESS: Final = 0xC0

EVENTS: Final = (
    ("SAMPLE", "new_sample", "a sample went through the filter"),
    ("RESTARTED", "restarted", "the filter loaded the measured tilt instead of stepping"),
    ("SATURATED", "saturated", "a count stood at the end of its range"),
    ("OVERRUN", "overrun", "a sample was lost because the filter was busy"),
    ("BUS_ERROR", "bus_error", "a transfer with the sensor failed"),
    ("UART_OVERRUN", "uart_overrun", "a received byte was lost because the one before was unread"),
    ("UART_FRAMING", "uart_framing", "a received byte had no stop bit"),
)
"""Name, element and cause of each event."""

COUNTERS: Final = (
    ("BUS_COUNTS", "Failed transfers with the sensor.", ("errors", "nacks")),
    ("STUCK_COUNTS", "Transfers that came to no end.", ("timeouts", "stuck_buses")),
    ("LOSS_COUNTS", "Restarts of the sensor and its lost samples.", ("restarts", "lost_samples")),
    ("LINK_COUNTS", "Samples that the telemetry link had no room for.", ("link_lost",)),
)


def register_map(
    design: FilterDesign, spec: FixedPointSpec, options: FpgaOptions = DEFAULT_FPGA_OPTIONS
) -> RegisterMap:
    """Return the registers of a design.

    Parameters
    ----------
    options
        Generics of the filter, which software can read.

    Raises
    ------
    HostkitError
        If the sensor cannot be set as the design asks, the filter has no core, or it has more
        settings than there is room for.
    """
    core = core_facts(spec, pipelined=options.pipelined)
    return RegisterMap(
        registers=(
            *constant_registers(design, spec, options, core),
            *_control_registers(),
            *setting_registers(design, spec),
            *_sample_registers(spec, core),
            *_count_registers(),
            *_counter_registers(),
        )
    )


def _control_registers() -> tuple[Register, ...]:
    groups = (
        ("CONTROL", "What software asks for; 1 in CLEAR, COMMIT or RESTORE acts once.", _control()),
        ("STATUS", "How things stand.", _status()),
        ("EVENTS", "What has happened; 1 clears, unless it happens again just then.", _events()),
        ("INTERRUPTS", "Events that raise the interrupt.", _interrupts()),
        ("UART_RX", "The byte the link received; a read takes it.", _uart()),
    )
    return _registers(CONTROL_ADDRESS, groups)


def _bit(
    name: str, low: int, element: str, description: str, access: Access = "ro", reset: int = 0
) -> Field:
    own = access != "ro" or element in ("retuned", "staged", "committing")
    return Field(
        name=name,
        description=description,
        low=low,
        width=1,
        access=access,
        source="decoder" if own else "core",
        element=element,
        reset=reset,
    )


def _control() -> tuple[Field, ...]:
    return (
        _bit("ENABLE", 0, "enable", "samples are taken", "rw", 1),
        _bit("CLEAR", 1, "clear", "restart the filter", "pulse"),
        _bit("COMMIT", 2, "commit", "take the written settings over, all at once", "pulse"),
        _bit("RESTORE", 3, "restore", "write the design's settings back", "pulse"),
    )


def _status() -> tuple[Field, ...]:
    return (
        _bit("RUNNING", 0, "running", "the sensor is configured and sampled"),
        _bit("FAILED", 1, "failed", "the sensor was refused; it is tried again"),
        _bit("BUSY", 2, "core_busy", "the filter has a sample in work"),
        _bit("RETUNED", 3, "retuned", "the settings in use are not the design's"),
        _bit("STAGED", 4, "staged", "settings were written and not committed"),
        _bit("COMMITTING", 5, "committing", "a commit waits for the filter"),
        Field(
            name="WHO_AM_I",
            description="identity of the sensor as read",
            low=8,
            width=8,
            element="identity",
        ),
    )


def _events() -> tuple[Field, ...]:
    return tuple(_bit(name, i, element, text, "w1c") for i, (name, element, text) in _numbered())


def _interrupts() -> tuple[Field, ...]:
    return tuple(
        _bit(name, i, f"{element}_interrupt", f"interrupt when {text}", "rw")
        for i, (name, element, text) in _numbered()
    )


def _numbered() -> tuple[tuple[int, tuple[str, str, str]], ...]:
    return tuple(enumerate(EVENTS))


def _uart() -> tuple[Field, ...]:
    return (
        Field(
            name="DATA",
            description="the byte, if VALID",
            low=0,
            width=8,
            access="pop",
            element="uart_data",
        ),
        Field(
            name="VALID",
            description="a byte was there and is taken by this read",
            low=8,
            width=1,
            access="pop",
            element="uart_valid",
        ),
    )


def _sample_registers(spec: FixedPointSpec, core: CoreFacts) -> tuple[Register, ...]:
    words = (
        _word("SAMPLE_NUMBER", "sequence", "Number of the sample."),
        _word("TIME_LOW", "time_us", "Microseconds; a read keeps TIME_HIGH."),
        (
            "TIME_HIGH",
            "High word of the time, as it was when TIME_LOW was read.",
            (
                Field(
                    name="VALUE",
                    description="microseconds / 2**32",
                    low=0,
                    width=32,
                    kind="unsigned",
                    element="time_us",
                    element_low=32,
                    latched_by="TIME_LOW",
                ),
            ),
        ),
        *(_angle_word(axis, axis in spec.axes) for axis in _AXES),
        *(
            _word(port.name.upper(), port.name, port.title, "signed", port.word is not None)
            for port in core.hidden_ports
        ),
    )
    return _registers(SAMPLE_ADDRESS, words)


def _count_registers() -> tuple[Register, ...]:
    words = (
        _counts("ACCEL_XY", "Specific force.", "accel_x", "accel_y"),
        _counts("ACCEL_Z_TEMPERATURE", "Specific force and temperature.", "accel_z", "temperature"),
        _counts("GYRO_XY", "Angular rate.", "gyro_x", "gyro_y"),
        _counts("GYRO_Z", "Angular rate.", "gyro_z"),
    )
    return _registers(SAMPLE_COUNTS_ADDRESS, words)


def _registers(
    address: int, words: tuple[tuple[str, str, tuple[Field, ...]], ...]
) -> tuple[Register, ...]:
    """Return registers of successive addresses."""
    return tuple(
        Register(
            name=name,
            address=address + WORD_BYTES * i,
            description=description,
            fields=fields,
        )
        for i, (name, description, fields) in enumerate(words)
    )


_AXES: Final[tuple[Axis, ...]] = ("roll", "pitch")
_Word = tuple[str, str, tuple[Field, ...]]


def _word(
    name: str, element: str, description: str, kind: Kind = "unsigned", present: bool = True
) -> _Word:
    field = Field(
        name="VALUE",
        description=description.rstrip(".").lower(),
        low=0,
        width=32,
        element=element,
        kind=kind,
        present=present,
    )
    return (name, description, (field,))


def _angle_word(axis: Axis, present: bool) -> _Word:
    name = f"ANGLE_{axis.upper()}"
    return _word(name, name.lower(), f"Angle of {axis}, half turns / 2**31.", "signed", present)


def _counts(name: str, description: str, *elements: str) -> _Word:
    fields = tuple(
        Field(
            name=element.upper(),
            description="counts, sensor axes" if "_" in element else "counts",
            low=16 * i,
            width=16,
            element=element,
            kind="signed",
        )
        for i, element in enumerate(elements)
    )
    return (name, description, fields)


def _counter_registers() -> tuple[Register, ...]:
    return tuple(
        Register(
            name=name,
            address=COUNTS_ADDRESS + WORD_BYTES * i,
            description=f"{description} Each stays at 65535.",
            fields=tuple(
                Field(
                    name=element.upper(),
                    description="count since reset",
                    low=16 * j,
                    width=16,
                    kind="unsigned",
                    element=element,
                )
                for j, element in enumerate(elements)
            ),
        )
        for i, (name, description, elements) in enumerate(COUNTERS)
    )
