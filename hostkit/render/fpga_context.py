"""What templates see of the FPGA: its options with every default resolved, and checked."""

import math
from dataclasses import dataclass

from hostkit.dialect import FRAME_OVERHEAD_BYTES, payload_bytes, sample_bytes, state_bytes
from hostkit.errors import RenderError
from hostkit.filters.core import Latency
from hostkit.render.core_context import CoreContext, core_context
from hostkit.render.fpga_options import Bus, FpgaOptions
from hostkit.render.link_plan import BITS_PER_BYTE, USABLE_PERCENT
from hostkit.render.options import FirmwareOptions, Identity, MessageRate
from hostkit.spec import FixedPointSpec
from hostkit.targets import Target
from hostkit.targets.clocking import ClockPlan
from hostkit.targets.uart import STANDARD_BAUDS

LOWEST_CLOCK_HZ = 10_000_000
"""A phase of the sensor's bus at 400 kHz lasts 7 clocks of it; less would be coarse."""
CLOCKS_PER_BIT = 8
"""The receiver of the serial line takes eight samples a bit."""
LOWEST_DEFAULT_BAUD = 115_200
SENSOR_READ_S = 0.75e-3
"""From the sample of the sensor to its counts, checked, at 400 kHz."""
STATE_FRAME_CLOCKS = 2200
"""What a frame of a sample and one of a state take in `hk_mavlink_tx` beside their bits."""
WAITING_SAMPLES = 2
"""One sample waits in the sensor's core while another one's state is sent; a third is lost if its
reading begins before the second is taken."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FpgaContext:
    """The options of an FPGA: see :class:`FpgaOptions`; clock and baud rate are numbers here.

    Attributes
    ----------
    clock
        How the clock is made from the oscillator of the board.
    core
        The core of the filter.
    """

    bus: Bus
    channels: int
    pipelined: bool
    clock_hz: int
    baud: int
    system_id: int
    identity: Identity
    top_name: str
    clock: ClockPlan
    core: CoreContext


def fpga_context(
    options: FpgaOptions, target: Target, spec: FixedPointSpec, rate_hz: float
) -> FpgaContext:
    """Fill in what the options leave to the target.

    Raises
    ------
    RenderError
        If the filter has no core of that kind, the clock cannot be made or is too slow for the
        sensor's bus, the serial line or the channels, or the serial line is too slow for the
        samples.
    """
    core = core_context(spec, options)
    clock = _clock(options, target)
    _require_channels(options.channels, clock.output_hz, rate_hz, core.clocks)
    return FpgaContext(
        bus=options.bus,
        channels=options.channels,
        pipelined=options.pipelined,
        clock_hz=clock.output_hz,
        baud=_baud(options.baud, clock.output_hz, rate_hz, core),
        system_id=options.system_id,
        identity=options.identity,
        top_name=options.top_name,
        clock=clock,
        core=core,
    )


def link_options(options: FpgaOptions, fpga: FpgaContext) -> FirmwareOptions:
    """Return the link of an FPGA as that of a firmware that sends samples and heartbeats only."""
    return FirmwareOptions(
        profile=options.profile,
        system_id=options.system_id,
        baud=fpga.baud,
        message_rates=tuple(MessageRate(name=n, rate_hz=0.0) for n in ("ATTITUDE", "SYS_STATUS")),
    )


def _clock(options: FpgaOptions, target: Target) -> ClockPlan:
    maker = target.clock_maker
    if maker is None or not target.boards:
        raise RenderError(f"{target.name} has no board, so there is no clock to make")
    input_hz = options.oscillator_hz or target.boards[0].oscillator_hz
    low, high = maker.input_hz
    if not low <= input_hz <= high:
        raise RenderError(f"oscillator_hz = {input_hz}; the {maker.title} takes {low} to {high} Hz")
    clock_hz = options.clock_hz or target.clock_hz
    low, high = max(LOWEST_CLOCK_HZ, maker.output_hz[0]), maker.output_hz[1]
    if not low <= clock_hz <= high:
        raise RenderError(
            f"clock_hz = {clock_hz}; it must be {low} Hz, for the sensor's bus at 400 kHz, to "
            f"{high} Hz, for the {maker.title}"
        )
    plan = maker.plan(input_hz, clock_hz)
    if plan is None:
        raise RenderError(
            f"clock_hz = {clock_hz}; the {maker.title} does not make it of {input_hz} Hz; the "
            f"nearest is {maker.nearest(input_hz, clock_hz)}"
        )
    return plan


def sample_frame_bytes(core: CoreContext) -> int:
    """Return the size of a frame of ``TILT_SAMPLE``."""
    return FRAME_OVERHEAD_BYTES + sample_bytes(len(core.told_ports))


def second_bytes(core: CoreContext) -> int:
    """Return what goes out once a second: a heartbeat and, if the core tells it, the state."""
    heartbeat = FRAME_OVERHEAD_BYTES + payload_bytes("HEARTBEAT")
    return heartbeat + (state_frame_bytes(core) if core.tells_state else 0)


def state_frame_bytes(core: CoreContext) -> int:
    """Return the size of a frame of ``TILT_STATE``."""
    return FRAME_OVERHEAD_BYTES + state_bytes(core.state_words)


def _baud(chosen: int | None, clock_hz: int, rate_hz: float, core: CoreContext) -> int:
    """Return the chosen baud rate or the slowest standard one, if it carries the samples."""
    needed = math.ceil(rate_hz * sample_frame_bytes(core) + second_bytes(core))
    if core.tells_state:
        needed = max(needed, _bytes_s_of_a_state(clock_hz, rate_hz, core))
    fits = [rate for rate in STANDARD_BAUDS if _usable_bytes_s(rate) >= needed]
    baud = chosen or next((rate for rate in fits if rate >= LOWEST_DEFAULT_BAUD), 0)
    if _usable_bytes_s(baud) < needed:
        raise RenderError(
            f"baud = {baud}; {rate_hz:g} samples a second need {needed} bytes/s, and it carries "
            f"{_usable_bytes_s(baud)} at {USABLE_PERCENT} % use; {fits[0]} would do"
        )
    if baud * CLOCKS_PER_BIT > clock_hz:
        raise RenderError(
            f"baud = {baud}; at {clock_hz} Hz the limit is {clock_hz // CLOCKS_PER_BIT}, "
            f"{CLOCKS_PER_BIT} clocks a bit"
        )
    return baud


def _bytes_s_of_a_state(clock_hz: int, rate_hz: float, core: CoreContext) -> int:
    """Return what the usable line must carry so that no sample is lost while a state is sent."""
    clocks = core.clocks.latency + STATE_FRAME_CLOCKS
    left_s = WAITING_SAMPLES / rate_hz - SENSOR_READ_S - clocks / clock_hz
    if left_s <= 0.0:
        raise RenderError(
            f"clock_hz = {clock_hz}; {rate_hz:g} samples a second leave no time for the state"
        )
    burst = sample_frame_bytes(core) + state_frame_bytes(core)
    return math.ceil(burst / left_s * USABLE_PERCENT / 100)


def _usable_bytes_s(baud: int) -> int:
    return baud // BITS_PER_BYTE * USABLE_PERCENT // 100


def _require_channels(channels: int, clock_hz: int, rate_hz: float, clocks: Latency) -> None:
    most = clocks.most_channels(clock_hz, rate_hz)
    if channels > most:
        raise RenderError(
            f"channels = {channels}; at {clock_hz} Hz, {clocks.interval} clocks a sample and "
            f"{rate_hz:g} samples a second the limit is {most}"
        )
