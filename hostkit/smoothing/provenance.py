"""Where trained settings come from, for their file."""

import platform
from collections.abc import Sequence
from importlib.metadata import version

import numpy as np

from hostkit import __version__
from hostkit.recordings import Recording
from hostkit.records import RecordingDigest
from hostkit.smoothing.settings_file import Provenance
from hostkit.smoothing.training import Trained, TrainingOptions
from hostkit.units import DEG_PER_RAD


def provenance(
    trained: Trained, options: TrainingOptions, recordings: Sequence[Recording]
) -> Provenance:
    """Return what a settings file remembers of a training."""
    held_out = trained.held_out_rad
    mean_deg = round(float(np.mean(held_out)) * DEG_PER_RAD, 6) if held_out else None
    return Provenance(
        optimiser=options.optimiser,
        seed=options.seed,
        evaluations=trained.evaluations,
        rmse_deg=round(trained.rmse_rad * DEG_PER_RAD, 6),
        held_out_rmse_deg=mean_deg,
        recordings=tuple(
            RecordingDigest(name=r.name, sha256=r.sha256, samples=len(r)) for r in recordings
        ),
        versions=(
            ("hostkit", __version__),
            ("numpy", version("numpy")),
            ("python", platform.python_version()),
            ("scipy", version("scipy")),
        ),
    )
