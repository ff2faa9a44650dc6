"""What a real sensor does wrong, in numbers."""

from dataclasses import dataclass

from hostkit.errors import HostkitError
from hostkit.units import RAD_PER_DEG, STANDARD_GRAVITY_M_S2

Triple = tuple[float, float, float]

MG = 1e-3 * STANDARD_GRAVITY_M_S2
STRENGTHS = (
    "gyro_bias_walk_rad_s_rts",
    "noise",
    "gyro_noise_density_rad_s_rthz",
    "accel_noise_density_m_s2_rthz",
    "vibration_m_s2",
)


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorErrors:
    """The errors of a simulated sensor; the defaults are a typical MPU-6050 after a rough look.

    Attributes
    ----------
    gyro_bias_rad_s
        Constant offset per axis. The data sheet allows 20 deg/s; what remains after the mean at
        standstill is taken off is some tenths.
    gyro_bias_walk_rad_s_rts
        Random walk of the offset, rad/s per root second, of all axes or of each.
    gyro_scale, accel_scale
        Relative scale error per axis; the data sheet allows 0.03.
    cross_axis
        Share of each axis seen by the two others; the data sheet allows 0.02.
    accel_offset_m_s2
        Constant offset per axis; the data sheet allows 50 mg on x and y, 80 mg on z.
    noise
        Factor on the noise densities; 0 for no noise.
    gyro_noise_density_rad_s_rthz, accel_noise_density_m_s2_rthz
        Measured one-sided noise density of the samples per axis; None for the data sheet's. The
        data sheet's is of the noise before the low-pass filter. A measured one has in it what that
        filter let through above half the sample rate, and the samples come out with it again.
    vibration_m_s2
        Root mean square of vibration along each axis, 20 to 120 Hz, before the low-pass filter.
    low_pass
        Whether the low-pass filter delays and smooths. Without it, noise is that of the whole
        internal bandwidth, 500 Hz or more.
    counts
        Whether values are clipped to the range and rounded to counts.
    """

    gyro_bias_rad_s: Triple = (0.3 * RAD_PER_DEG, -0.2 * RAD_PER_DEG, 0.25 * RAD_PER_DEG)
    gyro_bias_walk_rad_s_rts: float | Triple = 0.003 * RAD_PER_DEG
    gyro_scale: Triple = (0.005, -0.004, 0.003)
    accel_scale: Triple = (0.003, -0.003, 0.005)
    cross_axis: float = 0.003
    accel_offset_m_s2: Triple = (10.0 * MG, -10.0 * MG, 15.0 * MG)
    noise: float = 1.0
    gyro_noise_density_rad_s_rthz: Triple | None = None
    accel_noise_density_m_s2_rthz: Triple | None = None
    vibration_m_s2: float = 0.0
    low_pass: bool = True
    counts: bool = True

    def __post_init__(self) -> None:
        """Refuse negative strengths."""
        for name in STRENGTHS:
            value = getattr(self, name)
            values = value if isinstance(value, tuple) else (value or 0.0,)
            if not all(v >= 0.0 for v in values):
                raise HostkitError(f"{name} = {value} is negative; it is a strength, 0 for none")

    @classmethod
    def none(cls) -> "SensorErrors":
        """Return an ideal sensor: exact, without delay, range or counts."""
        return cls(
            gyro_bias_rad_s=(0.0, 0.0, 0.0),
            gyro_bias_walk_rad_s_rts=0.0,
            gyro_scale=(0.0, 0.0, 0.0),
            accel_scale=(0.0, 0.0, 0.0),
            cross_axis=0.0,
            accel_offset_m_s2=(0.0, 0.0, 0.0),
            noise=0.0,
            low_pass=False,
            counts=False,
        )
