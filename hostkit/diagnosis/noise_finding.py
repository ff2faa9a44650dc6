"""The noise of a sensor, in sentences."""

from hostkit.diagnosis.allan import OptionalTriple
from hostkit.diagnosis.noise import SensorNoise
from hostkit.units import DEG_PER_RAD, STANDARD_GRAVITY_M_S2

MICRO_G = 1e6 / STANDARD_GRAVITY_M_S2


def noise_sentences(noise: SensorNoise) -> tuple[str, str]:
    """Return what gyroscope and accelerometer read at rest besides the truth."""
    gyro, accel = noise.gyro, noise.accel
    return (
        f"gyro: density {_shown(gyro.noise_density, DEG_PER_RAD)} deg/s/rtHz, bias instability "
        f"{_shown(gyro.bias_instability, DEG_PER_RAD)} deg/s, bias walk "
        f"{_shown(gyro.random_walk, DEG_PER_RAD)} deg/s/rts (x, y, z; - where none is seen), from "
        f"{noise.duration_s:.4g} s of rest, {noise.samples} samples",
        f"accel: density {_shown(accel.noise_density, MICRO_G)} ug/rtHz, bias instability "
        f"{_shown(accel.bias_instability, MICRO_G)} ug, bias walk "
        f"{_shown(accel.random_walk, MICRO_G)} ug/rts",
    )


def _shown(values: OptionalTriple, per_unit: float) -> str:
    return " / ".join("-" if v is None else f"{v * per_unit:.3g}" for v in values)
