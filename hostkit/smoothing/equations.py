"""The equations between the states of a recording, and their solution by one banded matrix.

A node has twelve unknowns: a small rotation of the earth frame, velocity, position (earth frame)
and the bias of the gyroscope. Nine more are common to all nodes. See `hostkit.smoothing.smoother`
for what the equations say.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import solveh_banded

from hostkit.smoothing.preintegration import Blocks
from hostkit.smoothing.rotation import (
    IDENTITY,
    Array,
    back,
    cross_matrix,
    rotation_from_vector,
    turn,
    vector_from_rotation,
)
from hostkit.smoothing.settings import SmootherSettings
from hostkit.units import STANDARD_GRAVITY_M_S2

NODE = 12
PAIR = 2 * NODE
COMMON = 9
ROTATION, VELOCITY, POSITION, BIAS = (slice(3 * i, 3 * i + 3) for i in range(4))
ACCEL_OFFSET, ACCEL_SCALE, GYRO_SCALE = (slice(3 * i, 3 * i + 3) for i in range(3))
GRAVITY_M_S2: Array = np.array((0.0, 0.0, STANDARD_GRAVITY_M_S2))

PLACE_STEP_M = 1e-4
"""How exactly a step of position is the velocity's: loose enough for a sound matrix."""
HEADING_RAD = 1e-3
"""Holds the first heading, which nothing measures and nothing needs."""
DOUBTED_RAD_S = 1.0
"""Size of what a rate that is not believed lacks."""
FREE = 1e-9
"""Weight of unknowns without an equation of their own."""
TAIL = 2.0
"""Degrees of freedom of Student's t: far speeds are rare, not impossible (2: heavy tails)."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Estimate:
    """Orientation (K + 1, 3, 3), velocity, position and bias (K + 1, 3), and constants (9,)."""

    orientation: Array
    velocity_m_s: Array
    position_m: Array
    bias_rad_s: Array
    constants: Array


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class System:
    """The normal equations about an estimate, M = 12 (K + 1) unknowns of nodes and 9 of all.

    Attributes
    ----------
    banded, pull
        Matrix of the nodes as lower bands, shape ``(24, M)``, and its right side, ``(M,)``.
    border
        Products with the common unknowns, shape ``(M, 9)``.
    common, common_pull
        Matrix of the common unknowns, ``(9, 9)``, and its right side, ``(9,)``.
    residual, weight
        Of what ties two nodes, shape ``(K, 12)`` each.
    """

    banded: Array
    pull: Array
    border: Array
    common: Array
    common_pull: Array
    residual: Array
    weight: Array


def assemble(blocks: Blocks, settings: SmootherSettings, old: Estimate) -> System:
    """Return the normal equations about an estimate."""
    residual, slope, weight = _block_equations(blocks, settings, old)
    weighted = back(slope * weight[:, :, None])
    matrix, pull = weighted @ slope, turn(weighted, residual)
    node_weight, node_pull = _node_equations(blocks, settings, old)
    banded = _banded(matrix[:, :PAIR, :PAIR])
    banded[0] += node_weight
    sides = _both_ends(np.concatenate((pull[:, :PAIR, None], matrix[:, :PAIR, PAIR:]), axis=2))
    sides[..., 0] += node_pull
    flat = sides.reshape(-1, 1 + COMMON)
    prior = constants_weight(settings)
    return System(
        banded=banded.reshape(PAIR, -1),
        pull=flat[:, 0],
        border=flat[:, 1:],
        common=matrix[:, PAIR:, PAIR:].sum(axis=0) + np.diag(prior),
        common_pull=pull[:, PAIR:].sum(axis=0) + prior * old.constants,
        residual=residual,
        weight=weight,
    )


def improve(blocks: Blocks, settings: SmootherSettings, old: Estimate) -> Estimate:
    """Return the estimate after one step of Gauss and Newton.

    Raises
    ------
    numpy.linalg.LinAlgError
        If the equations contradict each other beyond what numbers hold.
    """
    system = assemble(blocks, settings, old)
    border = system.border
    # The common unknowns border the band: eliminate the nodes, solve for them, go back.
    sides = np.hstack((system.pull[:, None], border))
    solved = solveh_banded(system.banded, sides, lower=True, check_finite=False)
    inner = border.T @ solved
    constants = -np.linalg.solve(system.common - inner[:, 1:], system.common_pull - inner[:, 0])
    nodes = -(solved[:, 0] + solved[:, 1:] @ constants).reshape(-1, NODE)
    return Estimate(
        orientation=rotation_from_vector(nodes[:, ROTATION]) @ old.orientation,
        velocity_m_s=old.velocity_m_s + nodes[:, VELOCITY],
        position_m=old.position_m + nodes[:, POSITION],
        bias_rad_s=old.bias_rad_s + nodes[:, BIAS],
        constants=old.constants + constants,
    )


def _block_equations(
    blocks: Blocks, settings: SmootherSettings, old: Estimate
) -> tuple[Array, Array, Array]:
    """Residuals (K, 12), slopes (K, 12, 33) and weights (K, 12) of what ties two nodes."""
    time = blocks.duration_s[:, None]
    first, last = old.orientation[:-1], old.orientation[1:]
    from_last = last @ back(blocks.rotation)
    by_bias, by_rate, by_force = (
        first @ by for by in (blocks.by_bias_s, blocks.by_rate_rad, blocks.by_force_m_s)
    )
    gained, gained_last = turn(first, blocks.velocity_m_s), turn(from_last, blocks.velocity_m_s)
    bias, speed = _mean(old.bias_rad_s), _mean(old.velocity_m_s)
    gained_mean = 0.5 * (gained + gained_last) + turn(by_force, _spread(old, ACCEL_SCALE, bias))
    residual = np.hstack(
        (
            vector_from_rotation(from_last @ back(first))
            + turn(by_bias, bias)
            - turn(by_rate, _spread(old, GYRO_SCALE, bias)),
            np.diff(old.velocity_m_s, axis=0)
            - gained_mean
            + GRAVITY_M_S2 * time
            + turn(by_bias, _spread(old, ACCEL_OFFSET, bias)),
            np.diff(old.position_m, axis=0) - time * speed,
            np.diff(old.bias_rad_s, axis=0),
        )
    )
    slope = np.zeros((len(time), NODE, PAIR + COMMON))
    for part in (ROTATION, VELOCITY, POSITION, BIAS):
        slope[:, part, _end(part)], slope[:, part, part] = IDENTITY, -IDENTITY
    for end, force in ((0, gained), (NODE, gained_last)):
        slope[:, ROTATION, _shifted(BIAS, end)] = 0.5 * by_bias
        slope[:, VELOCITY, _shifted(ROTATION, end)] = 0.5 * cross_matrix(force)
        slope[:, POSITION, _shifted(VELOCITY, end)] = -0.5 * time[..., None] * IDENTITY
    slope[:, ROTATION, _shifted(GYRO_SCALE, PAIR)] = -by_rate
    slope[:, VELOCITY, _shifted(ACCEL_OFFSET, PAIR)] = by_bias
    slope[:, VELOCITY, _shifted(ACCEL_SCALE, PAIR)] = -by_force
    return residual, slope, _block_weight(blocks, settings)


def _block_weight(blocks: Blocks, settings: SmootherSettings) -> Array:
    time = blocks.duration_s
    unknown_rad = DOUBTED_RAD_S * blocks.doubted_s
    variances = (
        settings.gyro_noise_density_rad_s_rthz**2 * time + unknown_rad**2,
        settings.accel_noise_density_m_s2_rthz**2 * time,
        np.full_like(time, PLACE_STEP_M**2),
        settings.gyro_bias_walk_rad_s_rts**2 * time,
    )
    return 1.0 / np.repeat(np.stack(variances, axis=1), 3, axis=1)


def _node_equations(
    blocks: Blocks, settings: SmootherSettings, old: Estimate
) -> tuple[Array, Array]:
    """Weights and weighted residuals, (K + 1, 12) each, of what one node is by itself."""
    time = node_time_s(blocks)[:, None]
    weight, pull = np.full((len(time), NODE), FREE), np.zeros((len(time), NODE))
    for part, value, size in (
        (VELOCITY, old.velocity_m_s, settings.speed_m_s),
        (POSITION, old.position_m, settings.reach_m),
    ):
        excess = np.sum(value * value, axis=1, keepdims=True) / (size * size)
        weight[:, part] = time / (size * size) / (1.0 + excess / TAIL)
        pull[:, part] = weight[:, part] * value
    weight[0, BIAS] = settings.gyro_bias_rad_s**-2
    pull[0, BIAS] = weight[0, BIAS] * old.bias_rad_s[0]
    weight[0, ROTATION.stop - 1] = HEADING_RAD**-2
    return weight, pull


def node_time_s(blocks: Blocks) -> Array:
    """Return the time that each node stands for, shape ``(K + 1,)``."""
    half = 0.5 * blocks.duration_s
    return np.asarray(np.append(half, 0.0) + np.insert(half, 0, 0.0))


def constants_weight(settings: SmootherSettings) -> Array:
    """Return the weights that hold the common unknowns near zero, shape ``(9,)``."""
    sizes = (settings.accel_offset_m_s2, settings.accel_scale, settings.gyro_scale)
    return np.repeat(np.asarray(sizes) ** -2.0, 3)


def _banded(pairs: Array) -> Array:
    """Add the matrices of neighbouring nodes, (K, 24, 24), into lower bands (24, K + 1, 12)."""
    bands = np.zeros((PAIR, len(pairs) + 1, NODE))
    for column in range(PAIR):
        node, place = divmod(column, NODE)
        bands[: PAIR - column, node : node + len(pairs), place] += pairs[:, column:, column].T
    return bands


def _both_ends(pairs: Array) -> Array:
    """Add what belongs to the ends of blocks, (K, 24, C), at the nodes, (K + 1, 12, C)."""
    nodes = np.zeros((len(pairs) + 1, NODE, pairs.shape[2]))
    nodes[:-1] += pairs[:, :NODE]
    nodes[1:] += pairs[:, NODE:]
    return nodes


def _mean(values: Array) -> Array:
    return np.asarray(0.5 * (values[:-1] + values[1:]))


def _spread(old: Estimate, part: slice, like: Array) -> Array:
    return np.broadcast_to(old.constants[part], like.shape)


def _shifted(part: slice, by: int) -> slice:
    return slice(part.start + by, part.stop + by)


def _end(part: slice) -> slice:
    return _shifted(part, NODE)
