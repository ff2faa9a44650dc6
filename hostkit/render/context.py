"""What templates see: records whose fields are ready to be placed."""

import re
from dataclasses import dataclass

from hostkit import __version__
from hostkit.design_file import digest
from hostkit.errors import DesignError
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
from hostkit.render.sensor_program import SensorProgram, sensor_program
from hostkit.sensors import SENSORS, mpu6050
from hostkit.sensors.low_pass import LowPassSection, accel_section, gyro_section
from hostkit.sensors.part import COUNTS_PER_FULL_SCALE, Identity, Range, Register, RegisterWrite
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
class RangeContext:
    """A full-scale range and, as C99 hexadecimal text, its counts per rad/s or per m/s^2."""

    setting: int
    full_scale: int
    counts_per_si: str


@dataclass(frozen=True, slots=True, kw_only=True)
class LowPassContext:
    """A setting of the low-pass as C99 hexadecimal texts b0, b1, b2, a1, a2, and whole ticks."""

    setting: int
    coefficients: tuple[str, ...]
    delay_ticks: int


@dataclass(frozen=True, slots=True, kw_only=True)
class WakePeriodContext:
    """A rate of cycle mode: its setting and the time between two samples."""

    setting: int
    period_ms: int


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorContext:
    """The sensor: its map, its constants and the register writes of this design."""

    title: str
    i2c_address: int
    who_am_i: int
    registers: tuple[Register, ...]
    identities: tuple[Identity, ...]
    configuration: tuple[RegisterWrite, ...]
    variant_configuration: tuple[RegisterWrite, ...]
    frozen_samples: int
    settle_samples: int
    gyro_ranges: tuple[RangeContext, ...]
    accel_ranges: tuple[RangeContext, ...]
    rad_s_per_count: str
    m_s2_per_count: str
    gyro_low_passes: tuple[LowPassContext, ...]
    accel_low_passes: tuple[LowPassContext, ...]
    wake_periods: tuple[WakePeriodContext, ...]
    device_reset: int = mpu6050.DEVICE_RESET
    sleep: int = mpu6050.SLEEP
    clock_pll: int = mpu6050.CLOCK_PLL_GYRO_X
    signal_path_reset: int = mpu6050.SIGNAL_PATH_RESET_ALL
    data_ready: int = mpu6050.DATA_READY
    fifo_overflow: int = mpu6050.FIFO_OVERFLOW
    user_fifo: int = mpu6050.USER_FIFO
    user_fifo_reset: int = mpu6050.USER_FIFO_RESET
    fifo_temperature: int = mpu6050.FIFO_TEMPERATURE
    fifo_gyro_x: int = mpu6050.FIFO_GYRO_X
    fifo_accel: int = mpu6050.FIFO_ACCEL
    fifo_all: int = mpu6050.FIFO_ALL
    fifo_bytes: int = mpu6050.FIFO_BYTES
    self_test: int = mpu6050.SELF_TEST
    self_test_gyro_counts: str = mpu6050.SELF_TEST_GYRO_COUNTS.hex()
    self_test_gyro_growth: str = mpu6050.SELF_TEST_GYRO_GROWTH.hex()
    self_test_accel_counts: str = mpu6050.SELF_TEST_ACCEL_COUNTS.hex()
    self_test_accel_growth: str = mpu6050.SELF_TEST_ACCEL_GROWTH.hex()
    self_test_accel_setting: int = mpu6050.SELF_TEST_ACCEL_SETTING
    self_test_accel_range: int = 2 << mpu6050.SELF_TEST_ACCEL_SETTING
    self_test_gyro_trims: tuple[int, ...] = mpu6050.self_test_trims(
        mpu6050.SELF_TEST_GYRO_COUNTS, mpu6050.SELF_TEST_GYRO_GROWTH
    )
    self_test_accel_trims: tuple[int, ...] = mpu6050.self_test_trims(
        mpu6050.SELF_TEST_ACCEL_COUNTS, mpu6050.SELF_TEST_ACCEL_GROWTH
    )
    self_test_tolerance_percent: int = mpu6050.SELF_TEST_TOLERANCE_PERCENT
    self_test_gyro_config: int = 0
    self_test_accel_config: int = mpu6050.SELF_TEST_ACCEL_SETTING << mpu6050.FULL_SCALE_SHIFT
    self_test_gyro_spread: int = round(
        mpu6050.SELF_TEST_GYRO_SPREAD_DEG_S * COUNTS_PER_FULL_SCALE / 250
    )
    self_test_accel_spread: int = round(
        mpu6050.SELF_TEST_ACCEL_SPREAD_G
        * COUNTS_PER_FULL_SCALE
        / (2 << mpu6050.SELF_TEST_ACCEL_SETTING)
    )
    low_pass_rate_hz: int = mpu6050.LOW_PASS_TICK_HZ
    burst_bytes: int = mpu6050.BURST_BYTES
    temperature_counts_per_deg_c: int = mpu6050.TEMPERATURE_COUNTS_PER_DEG_C
    temperature_offset_counts: int = round(
        mpu6050.TEMPERATURE_COUNTS_PER_DEG_C * mpu6050.TEMPERATURE_OFFSET_DEG_C
    )


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
    sensor = _sensor_context(design)
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


def _sensor_context(design: FilterDesign) -> SensorContext:
    sensor = SENSORS[design.sensor.part]
    if sensor is not mpu6050.MPU6050:
        raise DesignError(f"there is no driver for the {sensor.title}; there is one for: mpu6050")
    tick_s = 1.0 / mpu6050.LOW_PASS_TICK_HZ
    return SensorContext(
        title=sensor.title,
        i2c_address=sensor.i2c_address,
        who_am_i=sensor.who_am_i,
        registers=sensor.registers,
        identities=sensor.identities,
        configuration=mpu6050.configuration(design.sensor, design.rate_hz),
        variant_configuration=mpu6050.variant_configuration(design.sensor),
        frozen_samples=mpu6050.frozen_samples(design.rate_hz),
        settle_samples=mpu6050.settle_samples(design.sensor, design.rate_hz),
        gyro_ranges=tuple(_range(r, sensor.gyro_rad_s_per_count(r)) for r in sensor.gyro_ranges),
        accel_ranges=tuple(_range(r, sensor.accel_m_s2_per_count(r)) for r in sensor.accel_ranges),
        rad_s_per_count=repr(sensor.rad_s_per_count(design.sensor)),
        m_s2_per_count=repr(sensor.m_s2_per_count(design.sensor)),
        gyro_low_passes=tuple(
            _low_pass(lp.setting, gyro_section(lp, tick_s)) for lp in sensor.low_passes
        ),
        accel_low_passes=tuple(
            _low_pass(lp.setting, accel_section(lp, tick_s)) for lp in sensor.low_passes
        ),
        wake_periods=tuple(
            WakePeriodContext(setting=setting, period_ms=period)
            for setting, period in enumerate(mpu6050.WAKE_PERIODS_MS)
        ),
    )


def _low_pass(setting: int, section: LowPassSection) -> LowPassContext:
    return LowPassContext(
        setting=setting,
        coefficients=tuple(c.hex() for c in (*section.numerator, *section.denominator)),
        delay_ticks=section.delay_ticks,
    )


def _range(full_scale: Range, si_per_count: float) -> RangeContext:
    return RangeContext(
        setting=full_scale.setting,
        full_scale=full_scale.full_scale,
        counts_per_si=(1.0 / si_per_count).hex(),
    )
