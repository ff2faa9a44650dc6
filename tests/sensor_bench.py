"""A bus master in front of the virtual sensor, for its tests."""

from pathlib import Path

import numpy as np
import pytest
from boards import generated, require_or_skip

from hostkit.emulation.board import PlannedFault, Stimulus
from hostkit.emulation.fault import KINDS
from hostkit.emulation.virtual_sensor import VirtualSensor, compile_shared
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import quantise

MS = 1_000_000
ADDRESS = 0x68
SMPLRT_DIV, CONFIG, GYRO_CONFIG, ACCEL_CONFIG = 0x19, 0x1A, 0x1B, 0x1C
INT_PIN_CFG, INT_ENABLE, INT_STATUS, BURST = 0x37, 0x38, 0x3A, 0x3B
SIGNAL_PATH_RESET, POWER, WHO_AM_I = 0x68, 0x6B, 0x75
PART = SENSORS["mpu6050"]


def table(rows: int = 20, settle: int = 0, *, loop: bool = False) -> Stimulus:
    rng = np.random.default_rng(11)
    return Stimulus(
        angular_rate_rad_s=rng.normal(0.0, 2.0, (rows, 3)),
        specific_force_m_s2=rng.normal(0.0, 9.0, (rows, 3)),
        temperature_deg_c=rng.uniform(-20.0, 60.0, rows),
        settle_samples=settle,
        loop=loop,
    )


@pytest.fixture(scope="session")
def library(tmp_path_factory: pytest.TempPathFactory) -> Path:
    require_or_skip("gcc")
    folder = generated("host", tmp_path_factory.mktemp("model"))
    compile_shared(folder, folder / "sensor.so")
    return folder / "sensor.so"


class Bench:
    """A bus master in front of a sensor; every call also lets a little time pass."""

    def __init__(self, library: Path, feels: Stimulus) -> None:
        self.library = library
        self.sensor = VirtualSensor(library, feels)
        self.feels = feels
        self.now = 0

    def wait(self, ns: int) -> None:
        self.now += ns
        self.sensor.advance(self.now)

    def write(self, register: int, *values: int) -> bool:
        ok = self.sensor.start(ADDRESS, read=False) and self.sensor.write(register)
        ok = ok and all(self.sensor.write(value) for value in values)
        self.sensor.stop()
        return ok

    def read(self, register: int, count: int = 1) -> list[int]:
        assert self.sensor.start(ADDRESS, read=False)
        assert self.sensor.write(register)
        assert self.sensor.start(ADDRESS, read=True)
        values = [self.sensor.read() for _ in range(count)]
        self.sensor.stop()
        return values

    def burst(self) -> list[int]:
        """Accel x, y, z, temperature, gyro x, y, z."""
        data = bytes(self.read(BURST, 14))
        return np.frombuffer(data, dtype=">i2").astype(int).tolist()

    def expected(self, row: int, *, gyro: int = 0, accel: int = 0) -> list[int]:
        f = self.feels
        force, rate = PART.accel_ranges[accel], PART.gyro_ranges[gyro]
        counts_force = quantise(f.specific_force_m_s2[row], PART.accel_m_s2_per_count(force))
        counts_rate = quantise(f.angular_rate_rad_s[row], PART.gyro_rad_s_per_count(rate))
        temperature = int(np.floor(f.temperature_deg_c[row] * 340 - 12420 + 0.5))
        return [*counts_force.tolist(), temperature, *counts_rate.tolist()]

    def configure(self, *, divider: int = 9, pin: int = 0x30) -> None:
        """Awake, settled, 1 kHz / (1 + divider), data-ready not yet enabled."""
        assert self.write(POWER, 0x01)
        self.wait(100 * MS)
        for register, value in ((CONFIG, 3), (SMPLRT_DIV, divider), (INT_PIN_CFG, pin)):
            assert self.write(register, value)

    def enable(self) -> None:
        assert self.write(INT_ENABLE, 0x01)

    def plan(self, name: str, *, row: int = 0, amount: int = 0) -> None:
        code = next(kind.code for kind in KINDS if kind.name == name)
        assert self.sensor.plan(PlannedFault(code=code, row=row, amount=amount))
