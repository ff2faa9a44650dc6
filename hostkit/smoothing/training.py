"""Settings fitted to recordings that have a reference, and their error on recordings left out."""

from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace

import numpy as np

from hostkit.errors import RecordingError
from hostkit.mounting import Mounting
from hostkit.optimisers import OPTIMISERS
from hostkit.recordings import Recording
from hostkit.records import AxisChoice
from hostkit.smoothing.known import KnownSensor
from hostkit.smoothing.pieces import ANY_SENSOR, PreparedRecording, prepare_recording
from hostkit.smoothing.recording import score
from hostkit.smoothing.rotation import Array
from hostkit.smoothing.settings import SmootherSettings
from hostkit.smoothing.smoother import solve

TRAINED = tuple(
    item.name
    for item in fields(SmootherSettings)
    if item.name not in ("gyro_full_scale_rad_s", "block_s", "lead_s")
)
LOWER: Array = np.log((0.001, 0.003, 1e-5, 1e-4, 1e-3, 1e-4, 1e-4, 0.01, 0.1))
UPPER: Array = np.log((0.2, 0.4, 2e-4, 1.0, 1.0, 0.05, 0.02, 0.3, 3.0))
"""Where settings are searched, in the order of `TRAINED`: from the best sensors to the worst."""
FIRST_SHARE = 0.25
"""Share of the evaluations that are spread over the whole box."""
NEAR = np.log(5.0)
"""How far from the best of those the swarm searches on."""
PARTICLES = 10
FEWEST_EVALUATIONS = 40
FOLDS = 5
HOPELESS_RAD = np.pi
"""Error of settings under which a recording cannot be solved."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TrainingOptions:
    """How settings are fitted.

    Attributes
    ----------
    evaluations
        Settings that one search tries; there is one for each fold and one for the result.
    seed
        Of the search.
    axes, mounting
        Angles whose error counts.
    start
        What is not trained: lead, block, full scale. It is also tried first.
    """

    evaluations: int = 160
    seed: int = 1
    optimiser: str = "qpso"
    axes: AxisChoice = "both"
    mounting: Mounting = field(default_factory=Mounting)
    start: SmootherSettings = field(default_factory=SmootherSettings)


@dataclass(frozen=True, slots=True, kw_only=True)
class Trained:
    """Fitted settings.

    Attributes
    ----------
    rmse_rad
        Mean over the recordings they were fitted to.
    held_out_rad
        RMSE of each recording under settings fitted without it; empty for a single recording.
    folds, evaluations
        Groups that were left out, and settings tried in all searches together.
    """

    settings: SmootherSettings
    rmse_rad: float
    held_out_rad: tuple[float, ...]
    folds: int
    evaluations: int


@dataclass(slots=True, kw_only=True)
class _Task:
    """The recordings, prepared once, and the errors of settings on them."""

    recordings: Sequence[Recording]
    prepared: Sequence[PreparedRecording]
    options: TrainingOptions
    tried: int = 0

    def errors(self, points: Array, which: Sequence[int]) -> Array:
        """Return the RMSE of settings ``(P, D)`` on recordings, shape ``(P, len(which))``."""
        self.tried += len(points)
        return np.array(
            [[self._error(settings_of(x, self.options.start), i) for i in which] for x in points]
        )

    def _error(self, settings: SmootherSettings, index: int) -> float:
        recording = self.recordings[index]
        up = np.full((len(recording), 3), np.nan)
        try:
            for piece in self.prepared[index].pieces:
                found = solve(piece.prepared, settings)
                up[piece.stretch.rows] = piece.stretch.at_rows(found.up)
        except RecordingError:
            return HOPELESS_RAD
        found_score = score(recording, up, self.options.axes, self.options.mounting)
        return HOPELESS_RAD if found_score is None else found_score.headline_rad()


def settings_of(point: Array, start: SmootherSettings) -> SmootherSettings:
    """Return the settings of a point of the search, logarithms of shape ``(9,)``."""
    values = {name: float(f"{np.exp(x):.4g}") for name, x in zip(TRAINED, point, strict=True)}
    return replace(start, **values)


def train(
    recordings: Sequence[Recording],
    options: TrainingOptions,
    known: KnownSensor = ANY_SENSOR,
) -> Trained:
    """Fit settings to recordings with a measured reference.

    The same settings spread over the whole box are tried for all folds; then a swarm for each fold
    searches on near the best of them, and never sees what is left out.

    Raises
    ------
    RecordingError
        If there is no recording, or one has no measured reference or cannot be smoothed.
    """
    _require_references(recordings, options)
    start = known.led(options.start)
    options = replace(options, start=start)
    task = _Task(
        recordings=recordings,
        prepared=[prepare_recording(recording, start, known) for recording in recordings],
        options=options,
    )
    everything = list(range(len(recordings)))
    first = _first_points(options)
    spread = task.errors(first, everything)
    folds = min(FOLDS, len(recordings)) if len(recordings) > 1 else 0
    held_out = np.zeros(len(recordings) if folds else 0)
    for fold in range(folds):
        rest = [i for i in everything if i % folds != fold]
        out = [i for i in everything if i % folds == fold]
        found = _search(task, rest, first, spread[:, rest].mean(axis=1), fold + 1)
        held_out[out] = task.errors(found[None], out)[0]
    best = _search(task, everything, first, spread.mean(axis=1), 0)
    return Trained(
        settings=settings_of(best, start),
        rmse_rad=float(task.errors(best[None], everything).mean()),
        held_out_rad=tuple(held_out.tolist()),
        folds=folds,
        evaluations=task.tried,
    )


def _require_references(recordings: Sequence[Recording], options: TrainingOptions) -> None:
    if not recordings:
        raise RecordingError("there is no recording to train on; name at least one")
    if options.evaluations < FEWEST_EVALUATIONS:
        raise RecordingError(
            f"{options.evaluations} evaluations are too few to train: {FEWEST_EVALUATIONS} at least"
        )
    for recording in recordings:
        nothing = np.zeros((len(recording), 3))
        nothing[:, 2] = 1.0
        if score(recording, nothing, options.axes, options.mounting) is None:
            raise RecordingError(
                f"recording {recording.name!r} has no measured reference at valid samples, which "
                "training needs. Without: smooth lets a recording choose its own settings"
            )


def _first_points(options: TrainingOptions) -> Array:
    """Return those to start with, then an even spread over the box (Latin hypercube)."""
    count = int(FIRST_SHARE * options.evaluations) - 1
    rng = np.random.default_rng(options.seed)
    cells = rng.permuted(np.tile(np.arange(count), (len(TRAINED), 1)), axis=1).T
    spread = LOWER + (UPPER - LOWER) * (cells + rng.random(cells.shape)) / count
    start = np.log([getattr(options.start, name) for name in TRAINED])
    return np.vstack((np.clip(start, LOWER, UPPER), spread))


def _search(task: _Task, which: list[int], first: Array, cost_rad: Array, stream: int) -> Array:
    """Search on near the best of the first points with a swarm; its best or the best of those."""
    centre = first[np.argmin(cost_rad)]
    moves = (task.options.evaluations - len(first)) // PARTICLES - 1
    found = OPTIMISERS[task.options.optimiser].minimise(
        lambda points: task.errors(points, which).mean(axis=1),
        np.maximum(LOWER, centre - NEAR),
        np.minimum(UPPER, centre + NEAR),
        particles=PARTICLES,
        iterations=max(1, moves),
        rng=np.random.default_rng((task.options.seed, stream)),
    )
    return found.x if found.cost < cost_rad.min() else centre
