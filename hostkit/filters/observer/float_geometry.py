"""Turns of a quaternion, as the float model of the observer makes them."""

from hostkit.filters.observer.limits import (
    FIRST_FORCE_G,
    FIRST_ROUNDS,
    LEAD_LIMIT_RAD,
)
from hostkit.units import STANDARD_GRAVITY_M_S2


def clamped(value: float, limit: float) -> float:
    """Return the nearest number in -limit to limit."""
    return min(max(value, -limit), limit)


def upright(force: list[float]) -> list[float]:
    """Return the turn that lays a specific force upwards, nearly so where it is not 1 g."""
    x, y, z = (clamped(f / STANDARD_GRAVITY_M_S2, FIRST_FORCE_G) / 2.0 for f in force)
    q = [0.5 + z, y, -x, 0.0] if z >= 0.0 else [y, 0.5 - z, 0.0, x]
    for _ in range(FIRST_ROUNDS):
        q = normalised(q)
    return q


def propagated(q: list[float], h: list[float]) -> list[float]:
    """Turn by twice `h` about the sensor's axes."""
    square = sum(x * x for x in h)
    cosine = 1.0 - square * (1.0 / 2.0 - square / 24.0)
    x, y, z = (part * (1.0 - square * (1.0 / 6.0 - square / 120.0)) for part in h)
    return [
        q[0] * cosine - q[1] * x - q[2] * y - q[3] * z,
        q[1] * cosine + q[0] * x + q[2] * z - q[3] * y,
        q[2] * cosine + q[0] * y + q[3] * x - q[1] * z,
        q[3] * cosine + q[0] * z + q[1] * y - q[2] * x,
    ]


def rows(q: list[float]) -> tuple[list[float], list[float]]:
    """Return the rows of the rotation from sensor to earth that give x and y."""
    w, x, y, z = q
    return (
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
    )


def corrected(q: list[float], half: tuple[float, float]) -> list[float]:
    """Turn by twice `half` about the earth's x and y."""
    x, y = half
    return [
        q[0] - x * q[1] - y * q[2],
        q[1] + x * q[0] + y * q[3],
        q[2] + y * q[0] - x * q[3],
        q[3] + x * q[2] - y * q[1],
    ]


def normalised(q: list[float]) -> list[float]:
    """Bring the length nearer to one."""
    more = 0.5 * (1.0 - sum(part * part for part in q))
    return [part + more * part for part in q]


def up(q: list[float]) -> list[float]:
    """Return the earth's up in sensor axes."""
    w, x, y, z = q
    return [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)]


def led(up_sensor: list[float], turn_rad_s: list[float], lead_s: float) -> list[float]:
    """Return up, advanced by what the sensor turns within the lead."""
    x, y, z = (clamped(lead_s * w, LEAD_LIMIT_RAD) for w in turn_rad_s)
    return [
        up_sensor[0] + up_sensor[1] * z - up_sensor[2] * y,
        up_sensor[1] + up_sensor[2] * x - up_sensor[0] * z,
        up_sensor[2] + up_sensor[0] * y - up_sensor[1] * x,
    ]
