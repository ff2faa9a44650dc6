"""What a back end of a fleet does, and how a worker is set so that every one computes the same."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Protocol

from hostkit.fleet.records import Finding, Job

THREAD_VARIABLES = ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS")
"""What the numeric libraries read when they are loaded; also what a Dask nanny sets to 1."""


class Workers(Protocol):
    """Something that works on jobs, a bounded number at a time."""

    def full(self) -> bool:
        """Tell whether one has to finish before another may be given."""

    def busy(self) -> bool:
        """Tell whether any job is not finished yet."""

    def submit(self, job: Job) -> None:
        """Give a job to a worker."""

    def wait(self) -> Finding:
        """Return the finding of a job that has finished, as soon as one has."""


def lost(job: Job, times: int) -> Finding:
    """Return the finding of a job whose worker died as often as is allowed."""
    return Finding(
        device=job.device,
        error=(
            f"its worker process died {times} times: it was killed, ran out of memory, or a "
            "library crashed"
        ),
    )


@contextmanager
def one_thread() -> Iterator[None]:
    """Make every process that is started meanwhile compute with one thread.

    Sums of long arrays depend on the number of threads in their last digit, so designs would.
    """
    before = {name: os.environ.get(name) for name in THREAD_VARIABLES}
    os.environ.update(dict.fromkeys(THREAD_VARIABLES, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value
