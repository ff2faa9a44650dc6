"""Turns of a quaternion in integers; a number after a letter says its fraction bits."""

from hostkit.filters.observer.limits import FIRST_ROUNDS
from hostkit.filters.observer.spec import ObserverSpec
from hostkit.units import STANDARD_GRAVITY_M_S2

Row = tuple[int, int, int]

SIXTH = round(2**32 / 6)
FIFTH = round(2**32 / 5)
TWENTY_FOURTH = round(2**32 / 24)
HALF_PER_G = round(2**35 / (2.0 * STANDARD_GRAVITY_M_S2))
"""1 / (2 g) with 35 fraction bits: from a force to the half-angle that it is off."""


def clamped(value: int, limit: int) -> int:
    """Return the nearest number in -limit to limit."""
    return limit if value > limit else -limit if value < -limit else value


def upright(spec: ObserverSpec, force: list[int]) -> list[int]:
    """Return the turn that lays a specific force upwards, 30."""
    limit, shift = spec.first_force_limit, spec.formats.first_force_shift
    x, y, z = ((clamped(f, limit) << shift) * HALF_PER_G >> 32 for f in force)
    q = [2**29 + z, y, -x, 0] if z >= 0 else [y, 2**29 - z, 0, x]
    for _ in range(FIRST_ROUNDS):
        q = normalised(q)
    return q


def propagated(q: list[int], turn: list[int]) -> list[int]:
    """Turn by twice the half-angles about the sensor's axes."""
    x, y, z = turn
    q0, q1, q2, q3 = q
    square = (x * x >> 32) + (y * y >> 32) + (z * z >> 32)
    part = square * TWENTY_FOURTH >> 32
    cosine = square * (2**31 - 1 - part) >> 32
    sine = square * (SIXTH - (part * FIFTH >> 32)) >> 32
    x -= x * sine >> 32
    y -= y * sine >> 32
    z -= z * sine >> 32
    return [
        q0 - (q0 * cosine >> 32) - (q1 * x >> 32) - (q2 * y >> 32) - (q3 * z >> 32),
        q1 - (q1 * cosine >> 32) + (q0 * x >> 32) + (q2 * z >> 32) - (q3 * y >> 32),
        q2 - (q2 * cosine >> 32) + (q0 * y >> 32) + (q3 * x >> 32) - (q1 * z >> 32),
        q3 - (q3 * cosine >> 32) + (q0 * z >> 32) + (q1 * y >> 32) - (q2 * x >> 32),
    ]


def earth_rows(q: list[int]) -> tuple[Row, Row]:
    """Return the rows of the rotation from sensor to earth that give x and y, 30."""
    q0, q1, q2, q3 = q
    q11, q22, q33 = q1 * q1 >> 32, q2 * q2 >> 32, q3 * q3 >> 32
    q12, q13, q23 = q1 * q2 >> 32, q1 * q3 >> 32, q2 * q3 >> 32
    q01, q02, q03 = q0 * q1 >> 32, q0 * q2 >> 32, q0 * q3 >> 32
    return (
        ((2**27 - q22 - q33) << 3, (q12 - q03) << 3, (q13 + q02) << 3),
        ((q12 + q03) << 3, (2**27 - q11 - q33) << 3, (q23 - q01) << 3),
    )


def corrected(q: list[int], half_x: int, half_y: int) -> list[int]:
    """Turn by twice the half-angles about the earth's x and y."""
    q0, q1, q2, q3 = q
    return [
        q0 - (half_x * q1 >> 32) - (half_y * q2 >> 32),
        q1 + (half_x * q0 >> 32) + (half_y * q3 >> 32),
        q2 + (half_y * q0 >> 32) - (half_x * q3 >> 32),
        q3 + (half_x * q2 >> 32) - (half_y * q1 >> 32),
    ]


def normalised(q: list[int]) -> list[int]:
    """Bring the length nearer to one."""
    q0, q1, q2, q3 = q
    square = (q0 * q0 >> 32) + (q1 * q1 >> 32) + (q2 * q2 >> 32) + (q3 * q3 >> 32)
    more = (2**28 - square) << 3
    return [part + (part * more >> 32) for part in q]
