"""Whether the filter that the diagnosis recommends is the better one of both, tuned."""

from collections.abc import Iterator

import numpy as np

from benchmarks.accuracy import SETS, DataSet, data_folder
from benchmarks.table import Table
from hostkit.comparison import CompareOptions, compare
from hostkit.diagnosis import diagnose, recommended_filter
from hostkit.mounting import Mounting
from hostkit.recordings import Recording, load

MORE = (
    DataSet(
        folder="repoimu_pendulum",
        title="RepoIMU pendulum, swing plane and across",
        mounting="+z+x+y",
    ),
    DataSet(folder="robot_mpu", title="Robot arm, pitch alone", axes="pitch"),
)
FILTERS = ("complementary", "observer")


def tables() -> Iterator[Table]:
    """Return one table over all sets of recordings.

    Raises
    ------
    HostkitError
        If there is no folder of recordings.
    """
    root = data_folder()
    rows = []
    for one in (*SETS, *MORE):
        files = sorted((root / one.folder).glob("*.npz"))
        if files:
            rows += _rows(one, tuple(load(file) for file in files))
    yield Table(
        title="Errors of both tuned filters while the recording was left out, deg, by what the "
        "diagnosis recommends for it",
        columns=("recordings", "recommended", "number", *FILTERS, "observer better in"),
        rows=tuple(rows),
    )


def _rows(one: DataSet, recordings: tuple[Recording, ...]) -> Iterator[tuple[str, ...]]:
    mounting = Mounting.parse(one.mounting)
    found = compare(recordings, CompareOptions(axes=one.axes, mounting=mounting, peers=()))
    each = {
        row.name: np.degrees(row.held_out.each_rad)
        for row in found.rows
        if row.held_out is not None
    }
    advice = [recommended_filter(diagnose(r, axes=one.axes, mounting=mounting)) for r in recordings]
    named = np.array(["-" if a is None else a.filter for a in advice])
    for name in FILTERS:
        chosen = named == name
        if chosen.any():
            means = [f"{np.mean(each[f][chosen]):.2f}" for f in FILTERS]
            better = int(np.sum(each["observer"][chosen] < each["complementary"][chosen]))
            count = int(chosen.sum())
            yield (one.title, name, str(count), *means, f"{better}")
