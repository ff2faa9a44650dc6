"""What the smoother believes about a sensor and its motion."""

from dataclasses import dataclass, fields

from hostkit.errors import DesignError

HIGHEST_LEAD_S = 0.1
LOWEST, HIGHEST = 1e-6, 1e3
"""Of any deviation in its own unit; beyond them double precision does not solve the equations."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SmootherSettings:
    """Standard deviations that weigh the equations of `hostkit.smoothing.smoother`.

    All but `lead_s` must be above zero. It is their ratios that weigh; speed and reach also say
    where heavy tails begin. A calibration constant is held at zero by a small deviation and left
    to the recording by a large one, which does harm where the recording turns too little to tell.

    Attributes
    ----------
    gyro_noise_density_rad_s_rthz
        White noise of the rate, with all that acts like it: tuned ones are far above data sheets.
    gyro_bias_rad_s, gyro_bias_walk_rad_s_rts
        Size of the bias at the start, and its random walk.
    gyro_scale
        Size of the scale error of the gyroscope.
    accel_noise_density_m_s2_rthz
        White noise of the specific force.
    accel_offset_m_s2, accel_scale
        Sizes of the accelerometer's offset and scale error.
    speed_m_s, reach_m
        How fast the body moves and how far from its mean place, counted once a second.
    gyro_full_scale_rad_s
        Rates from here on are clipped: the true ones are unknown. The default is beyond them all.
    block_s
        Time between the unknown states.
    lead_s
        How much later than told the samples were taken: the delay of the sensor's filter.
    """

    gyro_noise_density_rad_s_rthz: float = 0.0024
    gyro_bias_rad_s: float = 0.03
    gyro_bias_walk_rad_s_rts: float = 1e-5
    gyro_scale: float = 0.001
    accel_noise_density_m_s2_rthz: float = 0.025
    accel_offset_m_s2: float = 0.0005
    accel_scale: float = 0.0002
    speed_m_s: float = 0.06
    reach_m: float = 0.9
    gyro_full_scale_rad_s: float = HIGHEST
    block_s: float = 0.2
    lead_s: float = 0.0

    def __post_init__(self) -> None:
        """Refuse what cannot weigh an equation.

        Raises
        ------
        DesignError
            If a deviation is not a number above zero, or the lead is out of range.
        """
        for field in fields(self):
            value = getattr(self, field.name)
            lowest = 0.0 if field.name == "lead_s" else LOWEST
            highest = HIGHEST_LEAD_S if field.name == "lead_s" else HIGHEST
            if not lowest <= value <= highest:
                raise DesignError(
                    f"{field.name} = {value:g} of the smoother is outside [{lowest:g}, {highest:g}]"
                )
