"""What the README of an FPGA folder says in numbers."""

from dataclasses import dataclass

from hostkit.dialect import FRAME_OVERHEAD_BYTES, payload_bytes, sample_bytes
from hostkit.render.fpga_context import FpgaContext
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
    axes, method
        What the filter gives, in words.
    samples_per_s
        Most that the filter takes at the chosen clock.
    latency_us, interval_us
        Times of the filter; the latency is empty where it is not stated.
    most_channels
        Sensors of the design's rate that one filter could serve.
    sample_bytes, heartbeat_bytes, sample_us
        Frames on the serial line, and the time that one of a sample takes there.
    link_percent
        How much of the line is used.
    cells
        Measured resources; empty if they were not measured.
    """

    axes: str
    method: str
    samples_per_s: int
    latency_us: str
    interval_us: str
    most_channels: int
    sample_bytes: int
    heartbeat_bytes: int
    sample_us: str
    link_percent: str
    cells: tuple[CellCounts, ...]


def fpga_report(
    fpga: FpgaContext, spec: FixedPointSpec, rate_hz: float, cells: tuple[CellCounts, ...]
) -> FpgaReport:
    """Work out the figures of a system."""
    sample = FRAME_OVERHEAD_BYTES + sample_bytes(len(spec.hidden))
    heartbeat = FRAME_OVERHEAD_BYTES + payload_bytes("HEARTBEAT")
    bits_per_s = BITS_PER_BYTE * (rate_hz * sample + heartbeat)
    clocks, us = fpga.filter_clocks, 1e6 / fpga.clock_hz
    samples_per_s = clocks.samples_per_s(fpga.clock_hz)
    return FpgaReport(
        axes=" and ".join(spec.axes),
        method="arc sine" if spec.tilt == "arcsin" else "arc tangent",
        samples_per_s=samples_per_s,
        latency_us=f"{clocks.latency * us:.3g}" if clocks.latency else "",
        interval_us=f"{clocks.interval * us:.3g}",
        most_channels=int(samples_per_s // rate_hz),
        sample_bytes=sample,
        heartbeat_bytes=heartbeat,
        sample_us=f"{BITS_PER_BYTE * 1e6 * sample / fpga.baud:.0f}",
        link_percent=f"{100.0 * bits_per_s / fpga.baud:.1f}",
        cells=cells,
    )
