"""A Dask cluster as a back end: the scheduler is somebody's, hostkit only brings work."""

import importlib
import logging
import queue
import re
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any

from hostkit import __version__
from hostkit.errors import SchedulerError, ToolMissingError
from hostkit.fleet.job import Work, tune_device
from hostkit.fleet.place import place_here, unfit, work_there
from hostkit.fleet.records import Finding, Job, one_line
from hostkit.fleet.workers import lost
from hostkit.tuning.tune import versions

JOBS_PER_THREAD = 2
"""Given to the scheduler at a time: one at work, one that need not be waited for."""

TIMEOUT_S = 30.0
"""For the scheduler to answer, and for a cluster without workers to get one."""

POLL_S = 1.0
CLOSE_S = 5.0

LOGGERS = ("distributed", "distributed.client")
"""Dask tells a lost connection with a traceback; hostkit says it in a line."""

ADDRESS = r"((tcp|tls)://)?[^/\s]+:[0-9]{1,5}"
"""What Dask would only refuse after a minute must not reach it."""


class ClusterWorkers:
    """The workers of a Dask scheduler; see :class:`hostkit.fleet.workers.Workers`.

    Dask gives the jobs of a lost worker to another, and gives a job up that was with a lost worker
    more often than the scheduler allows. Such a job may only have waited behind the culprit, so it
    is tried once more when nothing else runs.

    Parameters
    ----------
    address
        Of the scheduler, such as ``tcp://192.0.2.7:8786``.
    folder
        The recordings; every worker must have them under the same path.
    work
        What workers do with a job.
    timeout_s
        For the scheduler to answer, and for a cluster without workers to get one.
    clock
        Seconds; tells when to look again how many workers there are.

    Raises
    ------
    SchedulerError
        If the address is none.
    ToolMissingError
        If Dask is not installed.
    """

    def __init__(
        self,
        *,
        address: str,
        folder: Path,
        work: Work = tune_device,
        timeout_s: float = TIMEOUT_S,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        if re.fullmatch(ADDRESS, address) is None:
            raise SchedulerError(
                f"{address!r} is no address of a scheduler; it looks like tcp://HOST:PORT"
            )
        self._distributed = _distributed()
        self._address = address
        self._folder = folder.resolve()
        self._work = work
        self._timeout_s = timeout_s
        self._clock = clock
        self._wanted = versions()
        self._running: dict[str, _Run] = {}
        self._suspects: list[Job] = []
        self._limit = 1
        self._idle_s = 0.0
        self._finished: queue.SimpleQueue[str] = queue.SimpleQueue()

    def __enter__(self) -> "ClusterWorkers":
        """Connect, and look at every worker.

        Raises
        ------
        SchedulerError
            If the scheduler cannot be reached, has no worker, or a worker would compute something
            else than this machine.
        """
        with ExitStack() as stack:
            stack.enter_context(_quiet())
            with self._reached("cannot be reached"):
                self._client = self._distributed.Client(
                    self._address, timeout=self._timeout_s, set_as_default=False
                )
            stack.callback(self._client.close, timeout=CLOSE_S)
            self._look_at_workers()
            self._stack = stack.pop_all()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: object, trace: TracebackType | None
    ) -> None:
        """Leave the scheduler; it drops what is not finished."""
        self._running.clear()
        self._stack.close()

    def full(self) -> bool:
        """Tell whether the workers have as many jobs as they shall have at a time."""
        return len(self._running) >= self._limit

    def busy(self) -> bool:
        """Tell whether a job is not finished, or has to be tried once more."""
        return bool(self._running or self._suspects)

    def submit(self, job: Job) -> None:
        """Give a job to the scheduler."""
        self._start(job, alone=False)

    def wait(self) -> Finding:
        """Return the next finding.

        Raises
        ------
        SchedulerError
            If the scheduler is lost, or has no worker for longer than the timeout.
        """
        if self._clock() - self._counted_s > POLL_S:
            self._count_threads()
        while True:
            if not self._running:
                self._start(self._suspects.pop(), alone=True)
            run = self._running.pop(self._next_key())
            finding = self._finding(run)
            if finding is not None:
                return finding
            self._suspects.append(run.job)

    def _start(self, job: Job, *, alone: bool) -> None:
        with self._reached("was lost"):
            future = self._client.submit(work_there, self._work, job, self._wanted, pure=False)
        self._running[future.key] = _Run(job=job, future=future, alone=alone)
        future.add_done_callback(lambda done: self._finished.put(done.key))

    def _finding(self, run: "_Run") -> Finding | None:
        """Return what came of a job, or None if it has to be tried alone."""
        try:
            return self._result(run.future)
        except self._distributed.KilledWorker as error:
            return lost(run.job, error.allowed_failures + 1) if run.alone else None
        except SchedulerError:
            raise
        except (self._distributed.CancelledError, OSError) as error:
            raise SchedulerError(f"the scheduler {self._address} was lost") from error
        except Exception as error:
            return Finding(device=run.job.device, error=one_line(repr(error)))

    def _result(self, future: Any) -> Finding:
        """Fetch a finding; if its worker is lost meanwhile, another computes it again."""
        while True:
            try:
                finding: Finding = future.result(timeout=POLL_S)
                return finding
            except self._distributed.TimeoutError:
                self._require_workers()

    def _next_key(self) -> str:
        while True:
            try:
                return self._finished.get(timeout=POLL_S)
            except queue.Empty:
                self._require_workers()

    def _require_workers(self) -> None:
        """Note that nothing came for a while, and give up if there is nobody to work."""
        self._idle_s = 0.0 if self._count_threads() else self._idle_s + POLL_S
        if self._idle_s >= self._timeout_s:
            raise SchedulerError(
                f"the scheduler {self._address} has had no worker for {self._idle_s:.0f} s"
            )

    def _count_threads(self) -> int:
        """Return the threads of all workers, and give the scheduler work for as many."""
        with self._reached("was lost"):
            threads = int(sum(self._client.nthreads().values()))
        self._limit = max(1, JOBS_PER_THREAD * threads)
        self._counted_s = self._clock()
        return threads

    def _look_at_workers(self) -> None:
        with self._reached("has no worker"):
            self._client.wait_for_workers(1, timeout=self._timeout_s)
        with self._reached(f"or a worker of it lacks hostkit {__version__}"):
            places = self._client.run(place_here, self._folder)
            through_scheduler = self._client.submit(place_here, self._folder, pure=False)
            through_scheduler.result(timeout=self._timeout_s)
        for worker, place in sorted(places.items()):
            if reason := unfit(place, self._wanted, self._folder):
                raise SchedulerError(f"worker {worker} {reason}")
        self._count_threads()

    @contextmanager
    def _reached(self, otherwise: str) -> Iterator[None]:
        """Turn what a call to the scheduler raises into a line that names the scheduler."""
        try:
            yield
        except Exception as error:
            reason = one_line(str(error) or type(error).__name__)
            raise SchedulerError(f"the scheduler {self._address} {otherwise}: {reason}") from error


@dataclass(frozen=True, slots=True, kw_only=True)
class _Run:
    job: Job
    future: Any
    alone: bool


def _distributed() -> Any:
    try:
        return importlib.import_module("distributed")
    except ImportError as error:
        raise ToolMissingError("--scheduler needs Dask: pip install 'hostkit[fleet]'") from error


@contextmanager
def _quiet() -> Iterator[None]:
    loggers = [logging.getLogger(name) for name in LOGGERS]
    before = [logger.level for logger in loggers]
    for logger in loggers:
        logger.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        for logger, level in zip(loggers, before, strict=True):
            logger.setLevel(level)
