from pathlib import Path

import numpy as np
import pytest
from diagnosis_cases import Simulate, Still, made, simulated

from hostkit.recordings import Recording
from hostkit.units import RAD_PER_DEG, STANDARD_GRAVITY_M_S2


@pytest.fixture(scope="session")
def moved() -> Simulate:
    return simulated


@pytest.fixture(scope="session")
def still() -> Still:
    return made


@pytest.fixture(scope="session")
def mpu6050_at_rest(data_folder: Path) -> Recording:
    """Ten minutes of a real sensor, its axes and units brought to those of a recording."""
    path = data_folder / "mpu6050_hmc5883l" / "unmoved-with-x-pointing-forward-10min.npz"
    with np.load(path) as raw:
        time_s = raw["t_us"] * 1e-6
        return Recording(
            name="mpu6050-at-rest",
            time_s=time_s,
            rate_hz=(len(time_s) - 1) / float(time_s[-1] - time_s[0]),
            angular_rate_rad_s=raw["gyr_dps_raw"] * (-RAD_PER_DEG, RAD_PER_DEG, RAD_PER_DEG),
            specific_force_m_s2=-STANDARD_GRAVITY_M_S2 * raw["acc_g"],
            valid=np.ones(len(time_s), dtype=np.bool_),
            temperature_deg_c=raw["temp_raw"],
        )
