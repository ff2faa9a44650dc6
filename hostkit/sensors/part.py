"""What hostkit knows of an inertial sensor: the record that every part fills in."""

from dataclasses import dataclass

from hostkit.errors import DesignError
from hostkit.records import SensorConfig
from hostkit.units import RAD_PER_DEG, STANDARD_GRAVITY_M_S2

COUNTS_PER_FULL_SCALE = 32768
"""A 16-bit sensor divides its full scale by 2^15; the datasheets' LSB figures are this, rounded."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Range:
    """One full-scale range: the register field that selects it, and how wide it is."""

    setting: int
    full_scale: int


@dataclass(frozen=True, slots=True, kw_only=True)
class LowPass:
    """One setting of the digital low-pass filter, as the register map lists it."""

    setting: int
    accel_bandwidth_hz: float
    accel_delay_s: float
    gyro_bandwidth_hz: float
    gyro_delay_s: float
    gyro_rate_hz: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Noise:
    """Noise figures of the datasheet, in SI units."""

    gyro_noise_density_rad_s_rthz: float
    accel_noise_density_m_s2_rthz: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Register:
    """One register: name, address and value after reset."""

    name: str
    address: int
    reset_value: int = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class RegisterWrite:
    """A value that the driver writes to a register and then reads back."""

    register: Register
    value: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Identity:
    """What an answer to the question for the identity means, and what the driver does then.

    Attributes
    ----------
    value
        The answer.
    part
        The part that answers so, for messages.
    accepted
        Whether the driver runs it; else it is refused, with the part's name.
    warned
        Whether the driver says that it is not the part of the design.
    own_accel_filter
        Whether the accelerometer has a low-pass register of its own.
    """

    value: int
    part: str
    accepted: bool = True
    warned: bool = True
    own_accel_filter: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorPart:
    """A sensor by its register map and figures.

    Attributes
    ----------
    gyro_ranges, accel_ranges
        Full scales in deg/s and in g, from narrow to wide.
    registers
        Every register the driver or the virtual sensor uses.
    identities
        Every answer to WHO_AM_I that is known; the driver refuses all others.
    """

    name: str
    title: str
    i2c_address: int
    who_am_i: int
    gyro_ranges: tuple[Range, ...]
    accel_ranges: tuple[Range, ...]
    low_passes: tuple[LowPass, ...]
    noise: Noise
    registers: tuple[Register, ...]
    identities: tuple[Identity, ...]
    sample_base_rate_hz: float
    sample_divider_max: int

    def gyro_range(self, config: SensorConfig) -> Range:
        """Return the gyroscope range of a configuration."""
        return _find(self.gyro_ranges, config.gyro_full_scale_deg_s, "gyro_full_scale_deg_s")

    def accel_range(self, config: SensorConfig) -> Range:
        """Return the accelerometer range of a configuration."""
        return _find(self.accel_ranges, config.accel_full_scale_g, "accel_full_scale_g")

    def low_pass(self, config: SensorConfig) -> LowPass:
        """Return the low-pass filter of a configuration."""
        for low_pass in self.low_passes:
            if low_pass.setting == config.low_pass_setting:
                return low_pass
        known = ", ".join(str(lp.setting) for lp in self.low_passes)
        raise DesignError(
            f"low_pass_setting = {config.low_pass_setting} does not exist on the {self.title}; "
            f"it has: {known}"
        )

    def gyro_rad_s_per_count(self, gyro_range: Range) -> float:
        """Return the weight of one count of angular rate in a range, rad/s."""
        return gyro_range.full_scale * RAD_PER_DEG / COUNTS_PER_FULL_SCALE

    def accel_m_s2_per_count(self, accel_range: Range) -> float:
        """Return the weight of one count of specific force in a range, m/s^2."""
        return accel_range.full_scale * STANDARD_GRAVITY_M_S2 / COUNTS_PER_FULL_SCALE

    def rad_s_per_count(self, config: SensorConfig) -> float:
        """Return the weight of one count of angular rate in a configuration, rad/s."""
        return self.gyro_rad_s_per_count(self.gyro_range(config))

    def m_s2_per_count(self, config: SensorConfig) -> float:
        """Return the weight of one count of specific force in a configuration, m/s^2."""
        return self.accel_m_s2_per_count(self.accel_range(config))

    def gravity_count(self, config: SensorConfig) -> int:
        """Return the accelerometer count of 1 g."""
        return COUNTS_PER_FULL_SCALE // self.accel_range(config).full_scale

    def sample_divider(self, rate_hz: float) -> int:
        """Return the sample-rate divider register for a rate.

        Raises
        ------
        DesignError
            If the part cannot make the rate within 0.1 %.
        """
        divider = round(self.sample_base_rate_hz / rate_hz) - 1
        divider = min(max(divider, 0), self.sample_divider_max)
        made_hz = self.sample_base_rate_hz / (divider + 1)
        if abs(made_hz / rate_hz - 1.0) > 1e-3:
            raise DesignError(
                f"rate_hz = {rate_hz:g} cannot be made by the {self.title}, whose rates are "
                f"{self.sample_base_rate_hz:g} Hz / n; the nearest is {made_hz:.6g} Hz"
            )
        return divider


def _find(ranges: tuple[Range, ...], full_scale: int, name: str) -> Range:
    for candidate in ranges:
        if candidate.full_scale == full_scale:
            return candidate
    known = ", ".join(str(r.full_scale) for r in ranges)
    raise DesignError(f"{name} = {full_scale} is not a range of the sensor; it has: {known}")
