"""Whether a worker elsewhere computes what this machine would, to the last digit."""

import os
from dataclasses import dataclass
from pathlib import Path

from hostkit.fleet.job import Work
from hostkit.fleet.records import Finding, Job
from hostkit.fleet.workers import THREAD_VARIABLES
from hostkit.tuning.tune import versions

Versions = tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Place:
    """What a process that computes designs is like, as far as the designs depend on it."""

    versions: Versions
    threads: tuple[str | None, ...]
    sees_folder: bool


def place_here(folder: Path) -> Place:
    """Describe this process."""
    return Place(
        versions=versions(),
        threads=tuple(os.environ.get(name) for name in THREAD_VARIABLES),
        sees_folder=folder.is_dir(),
    )


def unfit(place: Place, wanted: Versions, folder: Path) -> str:
    """Return why a process would not compute what the client would; empty if it would."""
    if place.versions != wanted:
        there, here = (", ".join(map(" ".join, found)) for found in (place.versions, wanted))
        return f"has {there}; designs would differ, it needs {here}"
    if set(place.threads) != {"1"}:
        names = ", ".join(THREAD_VARIABLES)
        return f"computes with several threads; start it with its nanny, or with {names} set to 1"
    if not place.sees_folder:
        return f"does not see {folder}; it needs the recordings under the same path"
    return ""


def work_there(work: Work, job: Job, wanted: Versions) -> Finding:
    """Do a job on a worker that may have joined after the others were looked at."""
    reason = unfit(place_here(job.folder), wanted, job.folder)
    return Finding(device=job.device, error=f"its worker {reason}") if reason else work(job)
