"""Many small rotations at once, as matrices."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

IDENTITY: Array = np.eye(3)


def turn(matrices: Array, vectors: Array) -> Array:
    """Return each matrix, shape ``(..., 3, 3)``, times its vector, shape ``(..., 3)``."""
    return np.asarray((matrices @ vectors[..., None])[..., 0])


def back(matrices: Array) -> Array:
    """Return the transposes of matrices, shape ``(..., 3, 3)``."""
    return np.swapaxes(matrices, -1, -2)


def cross_matrix(vectors: Array) -> Array:
    """Return the matrices ``[a]`` with ``[a] b = a x b``, shape ``(..., 3, 3)``."""
    matrices = np.zeros((*vectors.shape, 3))
    for row, column, axis in ((2, 1, 0), (0, 2, 1), (1, 0, 2)):
        matrices[..., row, column] = vectors[..., axis]
        matrices[..., column, row] = -vectors[..., axis]
    return matrices


def rotation_from_vector(vectors: Array) -> Array:
    """Return the rotations by ``|a|`` about ``a``, shape ``(..., 3, 3)`` (Rodrigues)."""
    angle = np.linalg.norm(vectors, axis=-1)[..., None, None]
    cross = cross_matrix(vectors)
    half = np.sinc(angle / (2.0 * np.pi))
    squared = cross @ cross
    return np.asarray(IDENTITY + np.sinc(angle / np.pi) * cross + 0.5 * half * half * squared)


def vector_from_rotation(matrices: Array) -> Array:
    """Return angle times axis, shape ``(..., 3)``, of rotations well below half a turn."""
    twice = np.stack(
        [matrices[..., i, j] - matrices[..., j, i] for i, j in ((2, 1), (0, 2), (1, 0))], axis=-1
    )
    sine = 0.5 * np.linalg.norm(twice, axis=-1, keepdims=True)
    cosine = 0.5 * (np.trace(matrices, axis1=-2, axis2=-1)[..., None] - 1.0)
    angle = np.arctan2(sine, cosine)
    return np.asarray(0.5 * twice / np.sinc(angle / np.pi))


def chain(steps: Array) -> Array:
    """Return the products of the first 0, 1, ... K matrices, shape ``(K + 1, 3, 3)``."""
    products = np.empty((len(steps) + 1, 3, 3))
    products[0] = IDENTITY
    for index, step in enumerate(steps):
        np.matmul(products[index], step, out=products[index + 1])
    return products
