"""What templates see of the FPGA: its options with every default resolved."""

from dataclasses import dataclass

from hostkit.render.fpga_options import Bus, FpgaOptions
from hostkit.render.options import FirmwareOptions, Identity, MessageRate
from hostkit.targets import Target

DEFAULT_CLOCK_HZ = 50_000_000
DEFAULT_BAUD = 115_200


@dataclass(frozen=True, slots=True, kw_only=True)
class FpgaContext:
    """The options of an FPGA: see :class:`FpgaOptions`; clock and baud rate are numbers here."""

    bus: Bus
    channels: int
    pipelined: bool
    clock_hz: int
    baud: int
    system_id: int
    identity: Identity
    top_name: str


def fpga_context(options: FpgaOptions, target: Target) -> FpgaContext:
    """Fill in what the options leave to the target."""
    return FpgaContext(
        bus=options.bus,
        channels=options.channels,
        pipelined=options.pipelined,
        clock_hz=options.clock_hz or target.clock_hz or DEFAULT_CLOCK_HZ,
        baud=options.baud or target.baud or DEFAULT_BAUD,
        system_id=options.system_id,
        identity=options.identity,
        top_name=options.top_name,
    )


def link_options(options: FpgaOptions) -> FirmwareOptions:
    """Return the link of an FPGA as that of a firmware that sends samples and heartbeats only."""
    return FirmwareOptions(
        profile=options.profile,
        system_id=options.system_id,
        message_rates=tuple(MessageRate(name=n, rate_hz=0.0) for n in ("ATTITUDE", "SYS_STATUS")),
    )
