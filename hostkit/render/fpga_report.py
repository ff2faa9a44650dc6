"""What the README of an FPGA folder says in numbers."""

from dataclasses import dataclass

from hostkit.dialect import FRAME_OVERHEAD_BYTES, payload_bytes
from hostkit.render.fpga_context import (
    FpgaContext,
    sample_frame_bytes,
    second_bytes,
    state_frame_bytes,
)
from hostkit.render.link_plan import BITS_PER_BYTE
from hostkit.spec import FixedPointSpec


@dataclass(frozen=True, slots=True, kw_only=True)
class CellCounts:
    """Cells of one entity after synthesis, and the tools that counted them."""

    entity: str
    lut: int
    flip_flops: int
    dsp: int
    block_ram: int
    tool: str


@dataclass(frozen=True, slots=True, kw_only=True)
class FpgaReport:
    """Figures of the system of a design.

    Attributes
    ----------
    axes
        What the filter gives, in words.
    samples_per_s
        Most that the filter takes at the chosen clock.
    latency_us, interval_us
        Times of the filter.
    most_channels
        Sensors of the design's rate that one filter could serve.
    sample_bytes, heartbeat_bytes, state_bytes, sample_us
        Frames on the serial line, and the time that one of a sample takes there; 0 where there is
        no frame of the state.
    link_percent
        How much of the line is used.
    cells
        Measured resources; empty if they were not measured.
    """

    axes: str
    samples_per_s: int
    latency_us: str
    interval_us: str
    most_channels: int
    sample_bytes: int
    heartbeat_bytes: int
    state_bytes: int
    sample_us: str
    link_percent: str
    cells: tuple[CellCounts, ...]


def fpga_report(
    fpga: FpgaContext, spec: FixedPointSpec, rate_hz: float, cells: tuple[CellCounts, ...]
) -> FpgaReport:
    """Work out the figures of a system."""
    sample = sample_frame_bytes(fpga.core)
    bits_per_s = BITS_PER_BYTE * (rate_hz * sample + second_bytes(fpga.core))
    clocks, us = fpga.core.clocks, 1e6 / fpga.clock_hz
    samples_per_s = clocks.samples_per_s(fpga.clock_hz)
    return FpgaReport(
        axes=" and ".join(spec.axes),
        samples_per_s=samples_per_s,
        latency_us=f"{clocks.latency * us:.3g}",
        interval_us=f"{clocks.interval * us:.3g}",
        most_channels=clocks.most_channels(fpga.clock_hz, rate_hz),
        sample_bytes=sample,
        heartbeat_bytes=FRAME_OVERHEAD_BYTES + payload_bytes("HEARTBEAT"),
        state_bytes=state_frame_bytes(fpga.core) if fpga.core.tells_state else 0,
        sample_us=f"{BITS_PER_BYTE * 1e6 * sample / fpga.baud:.0f}",
        link_percent=f"{100.0 * bits_per_s / fpga.baud:.1f}",
        cells=cells,
    )
