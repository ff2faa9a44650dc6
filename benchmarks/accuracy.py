"""Accuracy on public recordings beside the peers, with and without a lead."""

import math
import os
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from benchmarks.table import MISSING, Table
from hostkit.cli.inputs import say
from hostkit.comparison import CompareOptions, Comparison, Row, compare
from hostkit.errors import HostkitError
from hostkit.mounting import Mounting
from hostkit.recordings import load
from hostkit.records import AxisChoice

DATA = "HOSTKIT_DATA"
DEFAULT_FOLDER = Path(__file__).resolve().parents[2] / "shared" / "data"
"""Where the tests look for recordings, too."""
FAST = ("vqf-online", "vqf-offline", "imufusion")
SLOW = (*FAST, "mahony", "madgwick")
"""The package ahrs takes a tenth of a millisecond a sample, so it is run on short sets only."""
PLAIN = ("vqf-online",)
"""What is tuned without the scale of the gyroscope as well."""
EVALUATIONS = 240
LEAD_S = 0.0025
"""By so much the reference of BROAD is behind its sensor on nearly all trials."""


@dataclass(frozen=True, slots=True, kw_only=True)
class DataSet:
    """Recordings of one kind.

    Attributes
    ----------
    folder, title
        Below the folder of the data, and for a person.
    leads_s
        How far all are told ahead, a table each.
    """

    folder: str
    title: str
    axes: AxisChoice = "both"
    mounting: str = "+x+y+z"
    peers: tuple[str, ...] = FAST
    leads_s: tuple[float, ...] = (0.0,)


SETS = (
    DataSet(folder="upenn_arduimu", title="ArduIMU", peers=SLOW),
    DataSet(folder="robot_mpu", title="Robot arm with MPU-6050, 6500, 9150", peers=SLOW),
    DataSet(folder="repoimu_tstick", title="RepoIMU T-stick"),
    DataSet(
        folder="repoimu_pendulum",
        title="RepoIMU pendulum, angle of the swing",
        axes="roll",
        mounting="+z+x+y",
    ),
    DataSet(folder="broad", title="BROAD", leads_s=(0.0, LEAD_S)),
)


def tables() -> Iterator[Table]:
    """Return a table for each set of recordings and lead, tuned with and without gyro scale.

    Raises
    ------
    HostkitError
        If there is no folder of recordings.
    """
    root = data_folder()
    for one in SETS:
        files = sorted((root / one.folder).glob("*.npz"))
        if not files:
            say(f"accuracy: {root / one.folder} has no recordings")
            continue
        for lead_s in one.leads_s:
            yield _table(one, files, lead_s)


def data_folder() -> Path:
    """Return where the recordings are.

    Raises
    ------
    HostkitError
        If there is no such folder.
    """
    folder = Path(os.environ.get(DATA, DEFAULT_FOLDER))
    if not folder.is_dir():
        raise HostkitError(
            f"there are no recordings in {folder}, so there is no accuracy to measure; {DATA} "
            "names their folder, and docs/accuracy.md says where the public ones are"
        )
    return folder


def _table(one: DataSet, files: list[Path], lead_s: float) -> Table:
    recordings = tuple(load(file) for file in files)
    options = CompareOptions(
        axes=one.axes,
        mounting=Mounting.parse(one.mounting),
        peers=one.peers,
        lead_s=lead_s,
        evaluations=EVALUATIONS,
        jobs=os.cpu_count() or 1,
    )
    scaled = compare(recordings, options, say)
    plain = compare(recordings, replace(options, gyro_scale=False, peers=PLAIN), say)
    also = {row.name for row in scaled.rows if row.is_scaled}
    rows = [_cells(row, scaled) for row in scaled.rows]
    rows += [_cells(row, plain) for row in plain.rows if row.name in also and row.evaluations]
    return Table(
        title=f"{one.title}: {len(files)} recordings, RMSE of {scaled.quantity} in deg"
        + (f", told {lead_s * 1e3:g} ms ahead" if lead_s else ""),
        columns=("filter", "mean", "worst", "left out, mean", "left out, worst", "tried"),
        rows=tuple(sorted(rows, key=lambda row: float(row[3] if row[3] != MISSING else row[1]))),
        remarks=tuple(f"{m.name} is missing: {m.reason}" for m in scaled.missing),
    )


def _cells(row: Row, comparison: Comparison) -> tuple[str, ...]:
    words = f"{row.title}, {row.settings}{', gyro scale too' if row.is_scaled else ''}"
    if row.lead_s != comparison.lead_s:
        words += ", not ahead"
    left = (MISSING, MISSING)
    if row.held_out is not None:
        left = (_deg(row.held_out.rms_rad), _deg(row.honest_worst_rad))
    tried = str(row.evaluations) if row.evaluations else MISSING
    return (words, _deg(row.mean_rad), _deg(row.worst_rad), *left, tried)


def _deg(value_rad: float) -> str:
    return f"{math.degrees(value_rad):.3f}"
