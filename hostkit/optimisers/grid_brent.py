"""One parameter: a grid, then bounded Brent search in the best bracket. No swarm."""

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from hostkit.errors import HostkitError
from hostkit.optimisers.box import Box
from hostkit.optimisers.recorder import Recorder
from hostkit.optimisers.result import Cost, SwarmResult

Vector = NDArray[np.float64]

NAME = "grid-brent"
TITLE = "grid of 32 points, then Brent's search; one parameter only"
POINTS = 32
TOLERANCE = 1e-6
"""Distance at which the search ends, as a share of the width of the box."""


def minimise(
    cost: Cost,
    lower: Vector,
    upper: Vector,
    *,
    particles: int = 20,
    iterations: int = 100,
    rng: np.random.Generator,
    bounce: bool = True,
    patience: int | None = None,
    points: int = POINTS,
) -> SwarmResult:
    """Minimise a cost of one parameter: an even grid, then Brent's search around its best point.

    The grid is one call of `cost`; the search then asks for one point at a time, between the two
    neighbours of the grid's best. The box is searched as it is given: for a parameter that is a
    scale, such as a time constant, pass its logarithm.

    Parameters
    ----------
    cost, lower, upper
        As in :func:`hostkit.optimisers.qpso.minimise`, with D = 1.
    iterations
        Most steps of Brent's search; it rarely takes more than 40.
    particles, rng, bounce, patience
        Of the shared signature; this search has no swarm and nothing random.
    points
        Points of the grid, the two bounds included. A local minimum narrower than its spacing can
        be missed.

    Returns
    -------
    SwarmResult
        Its history is the best cost after the grid and after each step of Brent's search.

    Raises
    ------
    HostkitError
        If the box has more than one dimension or is none, the grid has fewer than three points or
        `iterations` is below one, or no cost is finite.

    References
    ----------
    R. P. Brent, "Algorithms for minimization without derivatives", Prentice-Hall 1973, chapter 5.
    """
    box = Box(lower=lower, upper=upper)
    _check(len(lower), points, iterations)
    recorder = Recorder(cost=cost, box=box)
    grid = np.linspace(lower[0], upper[0], points)
    found = recorder.batch(grid[:, np.newaxis])
    nearest = int(np.argmin(found))
    minimize_scalar(
        lambda x: recorder.single(np.array([x])),
        bounds=(grid[max(nearest - 1, 0)], grid[min(nearest + 1, points - 1)]),
        method="bounded",
        options={"xatol": TOLERANCE * float(box.width[0]), "maxiter": iterations},
    )
    return recorder.result()


def _check(dimensions: int, points: int, iterations: int) -> None:
    if dimensions != 1:
        raise HostkitError(
            f"{NAME} searches one parameter, the box has {dimensions}; a swarm or "
            "differential-evolution searches several"
        )
    if points < 3 or iterations < 1:
        raise HostkitError(
            f"{points} grid points and {iterations} iterations: at least 3 and 1 are needed"
        )
