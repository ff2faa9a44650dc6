"""A recording as blocks: each with what all its samples say about its two ends.

Within a block the rates are integrated once, from an unknown orientation at its start. What is
left of hundreds of samples is one rotation, one change of velocity, and how both change with bias
and scale; none of it has to be done again when the estimate changes.

References
----------
T. Lupton, S. Sukkarieh, "Visual-inertial-aided navigation for high-dynamic motion in built
environments without initial conditions", IEEE Trans. Robotics 28(1):61-76, 2012.
C. Forster, L. Carlone, F. Dellaert, D. Scaramuzza, "On-manifold preintegration for real-time
visual-inertial odometry", IEEE Trans. Robotics 33(1):1-21, 2017.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.smoothing.rotation import IDENTITY, Array, back, rotation_from_vector, turn


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Blocks:
    """K blocks of M samples between K + 1 nodes; vectors in the axes of the block's first sample.

    Attributes
    ----------
    duration_s
        Shape ``(K,)``; the last block may be shorter.
    within
        Rotation from each sample to the first one, shape ``(K, M + 1, 3, 3)``.
    doubted_s
        Time with a rate that is not believed, shape ``(K,)``.
    velocity_m_s
        Specific force integrated, shape ``(K, 3)``.
    by_bias_s, by_rate_rad, by_force_m_s
        The rotation, its product with the rates, and with the forces, each integrated, shape
        ``(K, 3, 3)``: how the two results change with a constant bias or scale.
    sample_count
        Samples of the recording.
    """

    duration_s: Array
    within: Array
    doubted_s: Array
    velocity_m_s: Array
    by_bias_s: Array
    by_rate_rad: Array
    by_force_m_s: Array
    sample_count: int

    @property
    def rotation(self) -> Array:
        """Rotation from the end of each block to its start, shape ``(K, 3, 3)``."""
        return self.within[:, -1]


def preintegrate(
    angular_rate_rad_s: Array,
    specific_force_m_s2: Array,
    period_s: float,
    samples: int,
    doubted: NDArray[np.bool_] | None = None,
) -> Blocks:
    """Gather samples in blocks of `samples`.

    A rate is taken as the mean over the period that ends with its sample, and a force as that of
    the sample's orientation. The first sample only tells where the first block starts.

    Parameters
    ----------
    angular_rate_rad_s, specific_force_m_s2
        Shape ``(N, 3)``, N at least 2.
    period_s
        Sample period.
    samples
        Samples of a block.
    doubted
        Samples whose rate is not believed, shape ``(N,)``: clipped ones, and those put into a gap.
    """
    count = len(angular_rate_rad_s)
    rate = _blocked(angular_rate_rad_s[1:], samples)
    force = _blocked(specific_force_m_s2[1:], samples)
    present = _blocked(np.ones((count - 1, 1)), samples)
    steps = rotation_from_vector(rate * period_s)
    within = np.empty((len(rate), samples + 1, 3, 3))
    within[:, 0] = IDENTITY
    for index in range(samples):
        within[:, index + 1] = within[:, index] @ steps[:, index]

    def integral(columns: Array) -> Array:
        return np.asarray(np.einsum("kmij,kmj->kij", within[:, 1:], columns) * period_s)

    unknown = np.zeros(count) if doubted is None else doubted.astype(np.float64)
    by_force = integral(force)
    return Blocks(
        duration_s=present.sum(axis=(1, 2)) * period_s,
        within=within,
        doubted_s=_blocked(unknown[1:, None], samples).sum(axis=(1, 2)) * period_s,
        velocity_m_s=by_force.sum(axis=2),
        by_bias_s=integral(np.broadcast_to(present, rate.shape)),
        by_rate_rad=integral(rate),
        by_force_m_s=by_force,
        sample_count=count,
    )


def _blocked(values: Array, samples: int) -> Array:
    """Split rows into blocks, shape ``(K, M, C)``; zeros fill the last one: no motion, no time."""
    blocks = -(-len(values) // samples)
    padded = np.zeros((blocks * samples, values.shape[1]))
    padded[: len(values)] = values
    return padded.reshape(blocks, samples, -1)


def up_of_samples(blocks: Blocks, orientation: Array, period_s: float) -> NDArray[np.float64]:
    """Return the up direction of each sample in sensor axes, shape ``(N, 3)``.

    Within a block the rates carry the first node's direction on; what they miss of the second
    one's is spread evenly.

    Parameters
    ----------
    blocks
        The recording.
    orientation
        Rotation from sensor to earth at each node, shape ``(K + 1, 3, 3)``.
    period_s
        Sample period.
    """
    at_node = orientation[:, 2]
    missed = turn(blocks.rotation, at_node[1:]) - at_node[:-1]
    samples = blocks.within.shape[1] - 1
    elapsed = np.arange(1, samples + 1) * period_s / blocks.duration_s[:, None]
    carried = at_node[:-1, None] + elapsed[..., None] * missed[:, None]
    up = turn(back(blocks.within[:, 1:]), carried).reshape(-1, 3)[: blocks.sample_count - 1]
    up = np.vstack((at_node[:1], up))
    return np.asarray(up / np.linalg.norm(up, axis=1, keepdims=True))
