"""What templates see: records whose fields are ready to be placed."""

import re
from dataclasses import dataclass

from hostkit import __version__
from hostkit.design_file import digest
from hostkit.filters import FILTERS
from hostkit.filters.arctan import ROOT_FRACTION_BITS, STRETCH_FRACTION_BITS
from hostkit.mounting import Mounting
from hostkit.records import FilterDesign
from hostkit.render.arctan_context import ArctanContext, arctan_context
from hostkit.render.choices import Options, firmware_options_of, fpga_options_of
from hostkit.render.fpga_context import FpgaContext, fpga_context, link_options
from hostkit.render.fpga_options import DEFAULT_FPGA_OPTIONS
from hostkit.render.fpga_report import CellCounts, FpgaReport, fpga_report
from hostkit.render.link_plan import LinkPlan, link_plan
from hostkit.render.mavlink_context import MavlinkContext, mavlink_context
from hostkit.render.options import FirmwareOptions
from hostkit.render.polar_context import PolarContext, polar_context
from hostkit.render.registers import RegistersContext, register_map, registers_context
from hostkit.render.sensor_context import SensorContext, sensor_context
from hostkit.render.sensor_program import SensorProgram, sensor_program
from hostkit.spec import FixedPointSpec
from hostkit.targets import Target


@dataclass(frozen=True, slots=True, kw_only=True)
class DesignContext:
    """The design by name and rate."""

    digest: str
    digest_bytes: tuple[int, ...]
    version: str
    version_number: int
    rate_hz: str
    period_us: int


@dataclass(frozen=True, slots=True, kw_only=True)
class MountingContext:
    """One body axis: the sensor axis it is, and whether it points the other way."""

    name: str
    source: int
    source_name: str
    negative: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class RenderContext:
    """Everything a template may name."""

    design: DesignContext
    spec: FixedPointSpec
    filter: object
    arctan: ArctanContext
    polar: PolarContext
    root_fraction_bits: int
    stretch_fraction_bits: int
    mounting: tuple[MountingContext, ...]
    has_roll: bool
    has_pitch: bool
    sensor: SensorContext
    sensor_program: SensorProgram
    link: LinkPlan
    options: FirmwareOptions
    fpga: FpgaContext | None
    report: FpgaReport | None
    mavlink: MavlinkContext | None
    registers: RegistersContext | None
    target: Target

    def banner(self, template: str) -> str:
        """Return the first comment of a rendered file."""
        return (
            f"made by hostkit {self.design.version} from design {self.design.digest}; "
            f"do not edit; template {template}"
        )


def render_context(
    design: FilterDesign,
    target: Target,
    options: Options | None = None,
    *,
    cells: tuple[CellCounts, ...] = (),
) -> RenderContext:
    """Lower a design and lay out what templates need.

    Parameters
    ----------
    cells
        Resources of an FPGA, if they were measured.

    Raises
    ------
    HostkitError
        If the design cannot be lowered, or does not fit the target's sensor rate or link, or
        there are options for a target of another kind.
    """
    filter_ = FILTERS[design.filter]
    spec = filter_.lower(design)
    chosen, fpga = DEFAULT_FPGA_OPTIONS, None
    if target.kind == "fpga":
        chosen = fpga_options_of(target, options)
        fpga = fpga_context(chosen, target, spec, design.rate_hz)
        firmware = link_options(chosen, fpga)
    else:
        firmware = firmware_options_of(target, options)
    sensor = sensor_context(design)
    return RenderContext(
        design=_design_context(design),
        spec=spec,
        filter=filter_.context(design, spec),
        arctan=arctan_context(spec.arctan),
        polar=polar_context(spec.arctan),
        root_fraction_bits=ROOT_FRACTION_BITS,
        stretch_fraction_bits=STRETCH_FRACTION_BITS,
        mounting=_mounting_context(design.mounting),
        has_roll="roll" in spec.axes,
        has_pitch="pitch" in spec.axes,
        sensor=sensor,
        sensor_program=sensor_program(
            sensor.configuration,
            sensor.variant_configuration,
            period_us=round(1e6 * design.period_s),
        ),
        link=link_plan(design.rate_hz, target, firmware, hidden_words=len(spec.hidden)),
        options=firmware,
        fpga=fpga,
        report=None if fpga is None else fpga_report(fpga, spec, design.rate_hz, cells),
        mavlink=None if fpga is None else _mavlink_context(fpga, firmware),
        registers=(None if fpga is None else registers_context(register_map(design, spec, chosen))),
        target=target,
    )


def _mavlink_context(fpga: FpgaContext, firmware: FirmwareOptions) -> MavlinkContext:
    return mavlink_context(
        firmware.identity,
        firmware.system_id,
        hidden_words=len(fpga.core.told_ports),
        state_words=fpga.core.state_words,
    )


def _design_context(design: FilterDesign) -> DesignContext:
    name = digest(design)
    return DesignContext(
        digest=name,
        digest_bytes=tuple(bytes.fromhex(name)),
        version=__version__,
        version_number=_version_number(__version__),
        rate_hz=repr(design.rate_hz),
        period_us=round(1e6 * design.period_s),
    )


def _version_number(version: str) -> int:
    """Return a version as AUTOPILOT_VERSION has it: bytes of major, minor, patch and kind."""
    parts = [int(part) for part in re.findall(r"\d+", version)[:3]]
    return int.from_bytes(bytes([*parts, 0, 0, 0, 0][:4]), "big")


def _mounting_context(mounting: Mounting) -> tuple[MountingContext, ...]:
    return tuple(
        MountingContext(name=name, source=source, source_name="xyz"[source], negative=sign < 0)
        for name, source, sign in zip("xyz", mounting.source, mounting.sign, strict=True)
    )
