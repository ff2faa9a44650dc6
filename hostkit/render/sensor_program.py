"""What the VHDL driver of the sensor does, step by step: the set-up, then the samples."""

from dataclasses import dataclass

from hostkit.sensors import mpu6050
from hostkit.sensors.part import Identity, Register, RegisterWrite

WAIT_TICKS = 26
"""What is at least 100 ms in ticks of 4.096 ms, the first of which may be short."""

SCALE_REGISTERS = (
    mpu6050.SMPLRT_DIV,
    mpu6050.CONFIG,
    mpu6050.GYRO_CONFIG,
    mpu6050.ACCEL_CONFIG,
)
"""They say what a count means, and are neighbours, so that one transfer reads them all."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ProgramStep:
    """One step: the operation as `hk_mpu6050_pkg` names it, register and value, and a comment."""

    operation: str
    name: str
    address: int = 0
    value: int = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorProgram:
    """The steps, and the places of some of them.

    Attributes
    ----------
    i2c_address
        Seven binary digits.
    accepted, variants
        Parts that are taken, and those with a low-pass register of their own.
    first_set, last_set
        The registers that are written and read back. They are looked at again while the sensor
        runs, and so is the next one, which lets samples come.
    first_scale, last_scale
        Of these, the ones that say what a count means.
    sample_step
        Where a sample is read.
    """

    i2c_address: str
    accepted: tuple[Identity, ...]
    variants: tuple[Identity, ...]
    steps: tuple[ProgramStep, ...]
    first_set: int
    first_scale: int
    last_scale: int
    last_set: int
    sample_step: int


def sensor_program(
    configuration: tuple[RegisterWrite, ...], variant: tuple[RegisterWrite, ...]
) -> SensorProgram:
    """Lay out the program for the registers of a design."""
    opening = _opening()
    scale = tuple(
        next(w for w in configuration if w.register == register) for register in SCALE_REGISTERS
    )
    others = [
        w
        for w in configuration
        if w.register not in SCALE_REGISTERS and w.register != mpu6050.INT_ENABLE
    ]
    sets = (
        *(_step("set", w.register, w.value) for w in (*others, *scale)),
        *(_step("variant", w.register, w.value) for w in variant),
        _step("set", mpu6050.PWR_MGMT_1, mpu6050.CLOCK_PLL_GYRO_X),
    )
    first = len(opening)
    steps = (
        *opening,
        *sets,
        _step("write", mpu6050.INT_ENABLE, mpu6050.DATA_READY),
        _step("sample", mpu6050.INT_STATUS, 0),
    )
    return SensorProgram(
        i2c_address=f"{mpu6050.MPU6050.i2c_address:07b}",
        accepted=tuple(i for i in mpu6050.IDENTITIES if i.accepted),
        variants=tuple(i for i in mpu6050.IDENTITIES if i.own_accel_filter),
        steps=steps,
        first_set=first,
        first_scale=first + len(others),
        last_scale=first + len(others) + len(scale) - 1,
        last_set=first + len(sets) - 1,
        sample_step=len(steps) - 1,
    )


def _opening() -> tuple[ProgramStep, ...]:
    """Return the steps before the registers of the design."""
    power = mpu6050.PWR_MGMT_1
    pause = ProgramStep(operation="wait", name="100 ms", value=WAIT_TICKS)
    return (
        _step("identify", mpu6050.WHO_AM_I, 0),
        _step("write", power, mpu6050.DEVICE_RESET),
        pause,
        _step("poll", power, power.reset_value),
        _step("write", power, mpu6050.CLOCK_PLL_GYRO_X),
        _step("write", mpu6050.SIGNAL_PATH_RESET, mpu6050.SIGNAL_PATH_RESET_ALL),
        pause,
        _step("write", mpu6050.INT_ENABLE, 0),
        _step("drop", mpu6050.INT_STATUS, 0),
    )


def _step(operation: str, register: Register, value: int) -> ProgramStep:
    return ProgramStep(
        operation=operation, name=register.name, address=register.address, value=value
    )
