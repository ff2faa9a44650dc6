"""What templates see of the sensor: its map, its constants and how a design configures it."""

from dataclasses import dataclass

from hostkit.errors import DesignError
from hostkit.records import FilterDesign
from hostkit.sensors import SENSORS, mpu6050
from hostkit.sensors.low_pass import LowPassSection, accel_section, gyro_section
from hostkit.sensors.part import COUNTS_PER_FULL_SCALE, Identity, Range, Register, RegisterWrite


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


def sensor_context(design: FilterDesign) -> SensorContext:
    """Lay out what templates need of the sensor.

    Raises
    ------
    DesignError
        If there is no driver for it.
    """
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
