"""What the VHDL driver of the sensor does, step by step: the set-up, then the samples."""

from dataclasses import dataclass

from hostkit.sensors import mpu6050
from hostkit.sensors.part import Identity, Register, RegisterWrite

SCALE_REGISTERS = (
    mpu6050.SMPLRT_DIV,
    mpu6050.CONFIG,
    mpu6050.GYRO_CONFIG,
    mpu6050.ACCEL_CONFIG,
)
"""They say what a count means, and are neighbours, so that one transfer reads them all."""

LONG_WAIT, SHORT_WAIT, RETREAT = 26, 4, 245
"""100 ms, 10 ms and 1 s in ticks of 4.096 ms, of which the first may be short."""

GAP_STEP, OVERDUE_STEP, UNLOOKED_STEP, REFUSED_STEP, BEGIN_STEP = 27, 28, 29, 30, 31
"""Places of the waits. The last place, behind REFUSED_STEP, comes before the first step."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ProgramStep:
    """One step: its place, the operation as `hk_mpu6050_pkg` names it, register and value."""

    place: int
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
    period_unit
        The unit of waits while the sensor runs is two to the power of this, in us.
    poll_step
        Where the end of the reset is waited for.
    first_set, last_set
        The registers that are written and read back. They are looked at again while the sensor
        runs, and so is the next one, which lets samples come.
    first_scale, last_scale
        Of these, the ones that say what a count means.
    sample_step
        Where a sample is read.
    gap_step, overdue_step, unlooked_step
        The waits after a look in vain, after a sample that was announced and one that was not.
    refused_step, begin_step
        The waits after an identity was refused, and before any is read.
    """

    i2c_address: str
    accepted: tuple[Identity, ...]
    variants: tuple[Identity, ...]
    steps: tuple[ProgramStep, ...]
    period_unit: int
    poll_step: int
    first_set: int
    first_scale: int
    last_scale: int
    last_set: int
    sample_step: int
    gap_step: int = GAP_STEP
    overdue_step: int = OVERDUE_STEP
    unlooked_step: int = UNLOOKED_STEP
    refused_step: int = REFUSED_STEP
    begin_step: int = BEGIN_STEP


_Action = tuple[str, str, int, int]
"""Operation, name, register, value."""


def sensor_program(
    configuration: tuple[RegisterWrite, ...],
    variant: tuple[RegisterWrite, ...],
    *,
    period_us: int,
) -> SensorProgram:
    """Lay out the program for the registers and the period of a design."""
    opening = _opening()
    scale = [
        next(w for w in configuration if w.register == register) for register in SCALE_REGISTERS
    ]
    others = [w for w in configuration if w not in scale and w.register != mpu6050.INT_ENABLE]
    sets = [
        *(_action("set", w.register, w.value) for w in (*others, *scale)),
        *(_action("variant", w.register, w.value) for w in variant),
        _action("set", mpu6050.PWR_MGMT_1, mpu6050.CLOCK_PLL_GYRO_X),
    ]
    actions = [
        *opening,
        *sets,
        _action("write", mpu6050.INT_ENABLE, mpu6050.DATA_READY),
        _action("sample", mpu6050.INT_STATUS, 0),
    ]
    first = len(opening)
    unit = max((period_us // 8).bit_length() - 1, 0)
    return SensorProgram(
        i2c_address=f"{mpu6050.MPU6050.i2c_address:07b}",
        accepted=tuple(i for i in mpu6050.IDENTITIES if i.accepted),
        variants=tuple(i for i in mpu6050.IDENTITIES if i.own_accel_filter),
        steps=(
            *(_step(place, action) for place, action in enumerate(actions)),
            *_waits(period_us, 1 << unit),
        ),
        period_unit=unit,
        poll_step=[action[0] for action in actions].index("poll"),
        first_set=first,
        first_scale=first + len(others),
        last_scale=first + len(others) + len(scale) - 1,
        last_set=first + len(sets) - 1,
        sample_step=len(actions) - 1,
    )


def _opening() -> tuple[_Action, ...]:
    """Return what is done before the registers of the design are written."""
    power = mpu6050.PWR_MGMT_1
    return (
        _action("identify", mpu6050.WHO_AM_I, 0),
        _action("write", power, mpu6050.DEVICE_RESET),
        ("wait", "100 ms", 0, LONG_WAIT),
        _action("poll", power, power.reset_value),
        _action("write", power, mpu6050.CLOCK_PLL_GYRO_X),
        _action("write", mpu6050.SIGNAL_PATH_RESET, mpu6050.SIGNAL_PATH_RESET_ALL),
        ("wait", "100 ms", 0, LONG_WAIT),
        _action("write", mpu6050.INT_ENABLE, 0),
        _action("drop", mpu6050.INT_STATUS, 0),
    )


def _waits(period_us: int, unit_us: int) -> tuple[ProgramStep, ...]:
    """Return the waits: those while the sensor runs depend on its period."""
    overdue = (period_us + period_us // 2) // unit_us + 1
    unlooked = (period_us - period_us // 8) // unit_us
    return tuple(
        _step(place, ("wait", name, 0, ticks))
        for place, name, ticks in (
            (GAP_STEP, "until the next look", 2),
            (OVERDUE_STEP, "1.5 periods", overdue),
            (UNLOOKED_STEP, "7/8 of a period", unlooked),
            (REFUSED_STEP, "1 s", RETREAT),
            (BEGIN_STEP, "10 ms", SHORT_WAIT),
        )
    )


def _action(operation: str, register: Register, value: int) -> _Action:
    return operation, register.name, register.address, value


def _step(place: int, action: _Action) -> ProgramStep:
    operation, name, address, value = action
    return ProgramStep(place=place, operation=operation, name=name, address=address, value=value)
