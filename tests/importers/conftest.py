from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from hostkit.importers import Imported, ImportOptions, import_recording
from hostkit.recordings import Recording
from hostkit.records import SensorConfig
from hostkit.simulation import SensorErrors, simulate

Bring = Callable[..., Imported]

SENSOR = SensorConfig(
    part="mpu6050", gyro_full_scale_deg_s=500, accel_full_scale_g=4, low_pass_setting=3
)


@cache
def simulated(profile: str, duration_s: float) -> Recording:
    return simulate(
        profile,
        duration_s=duration_s,
        rate_hz=100.0,
        sensor=SENSOR,
        errors=SensorErrors(),
        rng=np.random.default_rng(7),
    )


@pytest.fixture(scope="session")
def truth() -> Recording:
    """Twenty seconds of free motion at 100 Hz, with a reference."""
    return simulated("free", 20.0)


@pytest.fixture(scope="session")
def resting() -> Recording:
    """A sensor that lies still: nothing says how fast it turns."""
    return simulated("rest", 10.0)


@pytest.fixture(scope="session")
def bring() -> Bring:
    """Import a file with options given by name."""

    def call(path: Path, format_name: str | None = None, **options: object) -> Imported:
        chosen = ImportOptions(**options)  # type: ignore[arg-type]
        return import_recording(path, chosen, format_name=format_name)

    return call


def flip(vectors: np.ndarray) -> np.ndarray:
    """Between forward-left-up and forward-right-down, written out by hand."""
    return np.column_stack((vectors[:, 0], -vectors[:, 1], -vectors[:, 2]))


@pytest.fixture(scope="session")
def to_frd() -> Callable[[np.ndarray], np.ndarray]:
    return flip


@pytest.fixture(scope="session")
def tilt_of() -> Callable[[Recording], tuple[np.ndarray, np.ndarray]]:
    """Roll and pitch of the reference in hostkit's axes, rad."""

    def call(recording: Recording) -> tuple[np.ndarray, np.ndarray]:
        assert recording.up_reference is not None
        x, y, z = recording.up_reference.T
        return np.arctan2(y, z), np.arctan2(-x, np.hypot(y, z))

    return call
