"""Counts that try the gate, the bias and the offset of a design: its edges, and what is near."""

import math

import numpy as np

from hostkit.filters.complementary import BIAS_LIMIT_RAD_S, lower
from hostkit.filters.complementary.spec import ForceGate
from hostkit.records import FilterDesign

FULL_SCALE = 32767


def counts_with_square(square: int) -> tuple[int, int, int] | None:
    """Three counts whose squares add up to a number, or None where there are none."""
    for x in range(min(math.isqrt(square), FULL_SCALE), -1, -1):
        rest = square - x * x
        low = math.isqrt(rest // 2)
        for y in range(low, min(math.isqrt(rest), FULL_SCALE) + 1):
            z = math.isqrt(rest - y * y)
            if z * z == rest - y * y and z <= FULL_SCALE:
                return z, y, x
        if rest > 2**22:
            return None
    return None


def on_the_bounds(gate: ForceGate) -> np.ndarray:
    """Forces on the bounds of a gate and next to them, shut out and let through by turns."""
    wanted = [gate.lowest - 1, gate.lowest, gate.highest + 1, gate.highest]
    found = [c for square in wanted if square > 0 and (c := counts_with_square(square))]
    return np.array(found, dtype=np.int64)


def near_1_g(design: FilterDesign, samples: int = 150, seed: int = 7) -> np.ndarray:
    """Forces of 0.8 to 1.2 g in any direction, gyroscope counts of any size, shape ``(N, 6)``."""
    rng = np.random.default_rng(seed)
    spec = lower(design)
    direction = rng.normal(size=(samples, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    force = np.rint(direction * spec.gravity_count * rng.uniform(0.8, 1.2, (samples, 1)))
    if spec.gate is not None:
        edges = on_the_bounds(spec.gate)
        force = np.vstack([force, np.repeat(edges, 3, axis=0), edges[:, [2, 0, 1]]])
    rate = rng.integers(-32768, 32768, force.shape) >> rng.integers(0, 16, force.shape)
    return np.clip(np.hstack([force, rate]), -32768, 32767).astype(np.int64)


def against_the_limit(design: FilterDesign, samples: tuple[int, int]) -> np.ndarray:
    """At rest with a bias that no gyroscope has, one way and then the other, shape ``(N, 6)``.

    The rate is the largest at which no innovation reaches half a turn.
    """
    spec, sensor = lower(design), design.sensor
    rate_deg_s = 170.0 * spec.blend.real * design.rate_hz - math.degrees(BIAS_LIMIT_RAD_S)
    rate_count = round(rate_deg_s / sensor.gyro_full_scale_deg_s * 32768)
    counts = np.zeros((sum(samples), 6), dtype=np.int64)
    counts[:, design.mounting.source[2]] = design.mounting.sign[2] * spec.gravity_count
    counts[: samples[0], 3:], counts[samples[0] :, 3:] = rate_count, -rate_count
    return np.clip(counts, -32768, 32767)
