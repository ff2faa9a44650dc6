"""What one may choose of an FPGA beside its design: bus, clock, channels, names."""

from dataclasses import dataclass
from typing import Final, Literal, get_args

from hostkit.errors import RenderError
from hostkit.identifiers import require_identifier
from hostkit.render.options import (
    BAUD_LIMITS,
    IDENTITIES,
    Identity,
    Profile,
    require_one_of,
    require_system_id,
)

Bus = Literal["none", "axi4lite", "wishbone"]

CHANNEL_LIMITS: Final = (1, 1024)
OWN_PREFIX: Final = "hk_"
TOP_NAME: Final = "hk_top"
FOREIGN_NAMES: Final = frozenset(
    {"ieee", "std", "work", "unisim", "ibufg", "bufg", "iobuf", "dcm_sp", "ehxplll"}
)
"""Libraries and primitives that the tops use."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FpgaOptions:
    """Choices that leave the filter, and so the digest of the design, as they are.

    Attributes
    ----------
    bus
        Front end of the registers: none, AXI4-Lite or Wishbone.
    channels
        How many sensors one filter serves.
    pipelined
        Whether the filter takes a sample every clock, or is small and takes one at a time.
    clock_hz
        Clock of the system, Hz; None is the target's own.
    oscillator_hz
        Clock that the board gives, Hz; None is that of the target's first board.
    baud
        Rate of the telemetry link, bit/s; None is the target's own, or the slowest standard rate
        that carries the samples of the design.
    profile, system_id
        Who the device says it is on the link, as for the firmware.
    top_name
        Entity and file of the board's top.

    Raises
    ------
    RenderError
        If a value is not among those.
    """

    bus: Bus = "none"
    channels: int = 1
    pipelined: bool = False
    clock_hz: int | None = None
    oscillator_hz: int | None = None
    baud: int | None = None
    profile: Profile = "gcs"
    system_id: int = 1
    top_name: str = TOP_NAME

    def __post_init__(self) -> None:
        """Refuse what no FPGA can be."""
        require_one_of("bus", self.bus, get_args(Bus))
        require_one_of("profile", self.profile, get_args(Profile))
        require_system_id(self.system_id)
        low, high = CHANNEL_LIMITS
        if not low <= self.channels <= high:
            raise RenderError(f"channels = {self.channels}; it must be {low} to {high}")
        for name in ("clock_hz", "oscillator_hz"):
            clock_hz = getattr(self, name)
            if clock_hz is not None and clock_hz <= 0:
                raise RenderError(f"{name} = {clock_hz}; it must be above 0")
        low, high = BAUD_LIMITS
        if self.baud is not None and not low <= self.baud <= high:
            raise RenderError(f"baud = {self.baud}; it must be {low} to {high} bit/s")
        _require_free_name(self.top_name)

    @property
    def identity(self) -> Identity:
        """Who the device says it is."""
        return IDENTITIES[self.profile]


def _require_free_name(top_name: str) -> None:
    """Refuse what is no identifier, and what another unit, primitive or library is called."""
    require_identifier("top_name", top_name)
    name = top_name.lower()
    if name.startswith(OWN_PREFIX) and top_name != TOP_NAME:
        raise RenderError(
            f"top_name = {top_name!r}; names of hostkit's own units begin with {OWN_PREFIX}: take "
            f"another, or {TOP_NAME}"
        )
    if name in FOREIGN_NAMES:
        raise RenderError(
            f"top_name = {top_name!r} is the name of a primitive or a library; take another"
        )


DEFAULT_FPGA_OPTIONS: Final = FpgaOptions()
