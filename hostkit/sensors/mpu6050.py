"""The InvenSense MPU-6050: registers, ranges, filters and noise, the single source of all of them.

Sources: register map RM-MPU-6000A revision 4.2 and product specification PS-MPU-6000A revision
3.4. Driver, virtual sensor, simulation and lowering take their numbers from here.
"""

import math

from hostkit.errors import DesignError
from hostkit.records import SensorConfig
from hostkit.sensors.part import (
    Identity,
    LowPass,
    Noise,
    Range,
    Register,
    RegisterWrite,
    SensorPart,
)
from hostkit.units import RAD_PER_DEG, STANDARD_GRAVITY_M_S2

SELF_TEST_X = Register(name="SELF_TEST_X", address=0x0D)
SELF_TEST_Y = Register(name="SELF_TEST_Y", address=0x0E)
SELF_TEST_Z = Register(name="SELF_TEST_Z", address=0x0F)
SELF_TEST_A = Register(name="SELF_TEST_A", address=0x10)
SMPLRT_DIV = Register(name="SMPLRT_DIV", address=0x19)
CONFIG = Register(name="CONFIG", address=0x1A)
GYRO_CONFIG = Register(name="GYRO_CONFIG", address=0x1B)
ACCEL_CONFIG = Register(name="ACCEL_CONFIG", address=0x1C)
ACCEL_CONFIG_2 = Register(name="ACCEL_CONFIG_2", address=0x1D)
FIFO_EN = Register(name="FIFO_EN", address=0x23)
INT_PIN_CFG = Register(name="INT_PIN_CFG", address=0x37)
INT_ENABLE = Register(name="INT_ENABLE", address=0x38)
INT_STATUS = Register(name="INT_STATUS", address=0x3A)
ACCEL_XOUT_H = Register(name="ACCEL_XOUT_H", address=0x3B)
TEMP_OUT_H = Register(name="TEMP_OUT_H", address=0x41)
GYRO_XOUT_H = Register(name="GYRO_XOUT_H", address=0x43)
EXT_SENS_DATA_00 = Register(name="EXT_SENS_DATA_00", address=0x49)
SIGNAL_PATH_RESET = Register(name="SIGNAL_PATH_RESET", address=0x68)
USER_CTRL = Register(name="USER_CTRL", address=0x6A)
PWR_MGMT_1 = Register(name="PWR_MGMT_1", address=0x6B, reset_value=0x40)
PWR_MGMT_2 = Register(name="PWR_MGMT_2", address=0x6C)
FIFO_COUNT_H = Register(name="FIFO_COUNT_H", address=0x72)
FIFO_COUNT_L = Register(name="FIFO_COUNT_L", address=0x73)
FIFO_R_W = Register(name="FIFO_R_W", address=0x74)
WHO_AM_I = Register(name="WHO_AM_I", address=0x75, reset_value=0x68)

DEVICE_RESET = 0x80
SLEEP = 0x40
CLOCK_PLL_GYRO_X = 0x01
SIGNAL_PATH_RESET_ALL = 0x07
INT_LATCHED = 0x20
"""INT stays up until INT_STATUS is read, so that no other read can lose a sample."""
DATA_READY = 0x01
FIFO_OVERFLOW = 0x10
USER_FIFO = 0x40
USER_FIFO_RESET = 0x04
FIFO_TEMPERATURE = 0x80
FIFO_GYRO_X = 0x40
FIFO_ACCEL = 0x08
FIFO_ALL = 0xF8
FIFO_BYTES = 1024
SELF_TEST = 0xE0
FULL_SCALE_SHIFT = 3
BURST_BYTES = 14
LOW_PASS_TICK_HZ = 8000
"""The virtual sensor filters at the fastest rate of the part."""
WAKE_PERIODS_MS = (800, 200, 50, 25)
"""Cycle mode, LP_WAKE_CTRL 0 to 3: 1.25, 5, 20 and 40 Hz."""

SELF_TEST_ACCEL_SETTING = 2
SELF_TEST_GYRO_COUNTS = 25.0 * 131.0
SELF_TEST_GYRO_GROWTH = 1.046
SELF_TEST_ACCEL_COUNTS = 4096.0 * 0.34
SELF_TEST_ACCEL_GROWTH = (0.92 / 0.34) ** (1.0 / 30.0)
"""Factory trim of code 1, in counts of +-250 deg/s and of +-8 g, and its growth with each code."""

SELF_TEST_CODES = 31
SELF_TEST_TOLERANCE_PERCENT = 14
SELF_TEST_GYRO_SPREAD_DEG_S = 2.0
SELF_TEST_ACCEL_SPREAD_G = 0.05
"""A sensor whose samples are so far from the first is not at rest: its noise is a quarter of it."""

FROZEN_S = 0.5
FROZEN_SAMPLES_MIN = 50
"""A sensor that gives one sample over for so long, and so often, is taken for frozen."""

TEMPERATURE_COUNTS_PER_DEG_C = 340
TEMPERATURE_OFFSET_DEG_C = 36.53

IDENTITIES = (
    Identity(value=0x68, part="MPU-6050", warned=False),
    Identity(value=0x70, part="MPU-6500", own_accel_filter=True),
    Identity(value=0x71, part="MPU-9250", own_accel_filter=True),
    Identity(value=0x73, part="MPU-9255", own_accel_filter=True),
    Identity(value=0x98, part="ICM-20689", own_accel_filter=True),
    Identity(value=0x72, part="unknown clone"),
    Identity(value=0x74, part="MPU-6515", own_accel_filter=True),
    Identity(value=0x75, part="unknown clone"),
    Identity(value=0x12, part="ICM-20602", accepted=False),
)
"""Parts of compatible register map that are sold as MPU-6050, by their answer to WHO_AM_I.

Sources: the register map; the drivers of PX4 and Linux for the parts of the same maker; for the
clones reports of owners (Levi--G/IMU-WhoAmIVerifier 1, 2 and 3, ElectronicCats/mpu6050 21).
"""

MPU6050 = SensorPart(
    name="mpu6050",
    title="MPU-6050",
    i2c_address=0x68,
    who_am_i=0x68,
    gyro_ranges=tuple(Range(setting=i, full_scale=250 << i) for i in range(4)),
    accel_ranges=tuple(Range(setting=i, full_scale=2 << i) for i in range(4)),
    low_passes=tuple(
        LowPass(
            setting=setting,
            accel_bandwidth_hz=accel_hz,
            accel_delay_s=accel_ms * 1e-3,
            gyro_bandwidth_hz=gyro_hz,
            gyro_delay_s=gyro_ms * 1e-3,
            gyro_rate_hz=8000.0 if setting == 0 else 1000.0,
        )
        for setting, accel_hz, accel_ms, gyro_hz, gyro_ms in (
            (0, 260.0, 0.0, 256.0, 0.98),
            (1, 184.0, 2.0, 188.0, 1.9),
            (2, 94.0, 3.0, 98.0, 2.8),
            (3, 44.0, 4.9, 42.0, 4.8),
            (4, 21.0, 8.5, 20.0, 8.3),
            (5, 10.0, 13.8, 10.0, 13.4),
            (6, 5.0, 19.0, 5.0, 18.6),
        )
    ),
    noise=Noise(
        gyro_noise_density_rad_s_rthz=0.005 * RAD_PER_DEG,
        accel_noise_density_m_s2_rthz=400e-6 * STANDARD_GRAVITY_M_S2,
    ),
    registers=(
        SELF_TEST_X,
        SELF_TEST_Y,
        SELF_TEST_Z,
        SELF_TEST_A,
        SMPLRT_DIV,
        CONFIG,
        GYRO_CONFIG,
        ACCEL_CONFIG,
        ACCEL_CONFIG_2,
        FIFO_EN,
        INT_PIN_CFG,
        INT_ENABLE,
        INT_STATUS,
        ACCEL_XOUT_H,
        TEMP_OUT_H,
        GYRO_XOUT_H,
        EXT_SENS_DATA_00,
        SIGNAL_PATH_RESET,
        USER_CTRL,
        PWR_MGMT_1,
        PWR_MGMT_2,
        FIFO_COUNT_H,
        FIFO_COUNT_L,
        FIFO_R_W,
        WHO_AM_I,
    ),
    identities=IDENTITIES,
    sample_base_rate_hz=1000.0,
    sample_divider_max=255,
)


def configuration(config: SensorConfig, rate_hz: float) -> tuple[RegisterWrite, ...]:
    """Return what the driver writes, in order, between wake-up and enabling data-ready.

    Everything that changes the weight of a count stands before the interrupt is enabled: a sample
    taken before would be scaled by the wrong range.

    Raises
    ------
    DesignError
        If a range, the low-pass setting or the rate does not exist on the part, or if the rate
        needs the filter's 1 kHz clock and the low-pass setting 0 runs at 8 kHz.
    """
    gyro = MPU6050.gyro_range(config)
    accel = MPU6050.accel_range(config)
    low_pass = MPU6050.low_pass(config)
    ticks_per_base = round(low_pass.gyro_rate_hz / MPU6050.sample_base_rate_hz)
    divider = (MPU6050.sample_divider(rate_hz) + 1) * ticks_per_base - 1
    if divider > MPU6050.sample_divider_max:
        slowest = low_pass.gyro_rate_hz / (MPU6050.sample_divider_max + 1)
        raise DesignError(
            f"rate_hz = {rate_hz:g} is too slow for low_pass_setting 0, which runs at 8 kHz and "
            f"goes down to {slowest:g} Hz; take a setting from 1 to 6"
        )
    return (
        RegisterWrite(register=INT_ENABLE, value=0),
        RegisterWrite(register=USER_CTRL, value=0),
        RegisterWrite(register=FIFO_EN, value=0),
        RegisterWrite(register=PWR_MGMT_2, value=0),
        RegisterWrite(register=CONFIG, value=low_pass.setting),
        RegisterWrite(register=SMPLRT_DIV, value=divider),
        RegisterWrite(register=GYRO_CONFIG, value=gyro.setting << FULL_SCALE_SHIFT),
        RegisterWrite(register=ACCEL_CONFIG, value=accel.setting << FULL_SCALE_SHIFT),
        RegisterWrite(register=INT_PIN_CFG, value=INT_LATCHED),
    )


def variant_configuration(config: SensorConfig) -> tuple[RegisterWrite, ...]:
    """Return what is written besides to a part whose accelerometer has its own low-pass register.

    Its settings 1 to 6 have nearly the bandwidths of the MPU-6050's common filter.
    """
    return (RegisterWrite(register=ACCEL_CONFIG_2, value=MPU6050.low_pass(config).setting),)


def self_test_trims(counts: float, growth: float) -> tuple[int, ...]:
    """Return the factory trim of the self-test codes 1 to 31, in counts, rounded.

    RM-MPU-6000A, section 4.1: `counts` times `growth` for each code above 1.
    """
    return tuple(round(counts * growth**i) for i in range(SELF_TEST_CODES))


def frozen_samples(rate_hz: float) -> int:
    """Return after how many samples that are equal in every bit the sensor is taken for frozen."""
    return max(FROZEN_SAMPLES_MIN, math.ceil(FROZEN_S * rate_hz))


def settle_samples(config: SensorConfig, rate_hz: float) -> int:
    """Return how many samples after start-up still see the filter's old state.

    One sample that may have been taken before the interrupt was enabled, and three group delays of
    the low-pass filter.
    """
    low_pass = MPU6050.low_pass(config)
    delay_s = max(low_pass.accel_delay_s, low_pass.gyro_delay_s)
    return 1 + math.ceil(3.0 * delay_s * rate_hz)
