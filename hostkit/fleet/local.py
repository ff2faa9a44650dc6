"""The cores of this machine as a back end: a pool of one process for each core.

Pools of one process, because where a process dies the job that killed it is then known, and no
other is lost with it. The processes are forked by a server that has already loaded hostkit, so one
more costs milliseconds, and a process that died is quickly replaced.
"""

import multiprocessing
import os
import queue
import signal
import threading
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import ExitStack
from dataclasses import dataclass
from multiprocessing.connection import Connection
from types import TracebackType

from hostkit.fleet.job import Work, tune_device
from hostkit.fleet.records import Finding, Job, one_line
from hostkit.fleet.workers import lost, one_thread

ATTEMPTS = 2
"""A process may be killed by mistake once; the second time it is the device's fault."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Run:
    job: Job
    pool: ProcessPoolExecutor
    attempt: int


class LocalWorkers:
    """Processes on this machine; see :class:`hostkit.fleet.workers.Workers`.

    Each computes with one thread, and ends when this process does, however that ends. Used from a
    script, the script needs ``if __name__ == "__main__":``, as multiprocessing does.

    Parameters
    ----------
    jobs
        Processes at a time, at least 1.
    work
        What they do with a job.
    """

    def __init__(self, *, jobs: int, work: Work = tune_device) -> None:
        self._jobs = jobs
        self._work = work
        self._context = multiprocessing.get_context("forkserver")
        self._context.set_forkserver_preload([tune_device.__module__])
        self._idle: list[ProcessPoolExecutor] = []
        self._running: dict[Future[Finding], _Run] = {}
        self._finished: queue.SimpleQueue[Future[Finding]] = queue.SimpleQueue()
        self._stack = ExitStack()

    def __enter__(self) -> "LocalWorkers":
        """Prepare; a process is started when there is a job for it."""
        self._stack.enter_context(one_thread())
        self._lifeline, self._hold = self._context.Pipe(duplex=False)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: object, trace: TracebackType | None
    ) -> None:
        """End the processes: at once if they are still at work."""
        if self._running:
            self._hold.close()
        for pool in (*self._idle, *(run.pool for run in self._running.values())):
            pool.shutdown(wait=True, cancel_futures=True)
        self._hold.close()
        self._lifeline.close()
        self._stack.close()

    def full(self) -> bool:
        """Tell whether every process has a job."""
        return len(self._running) >= self._jobs

    def busy(self) -> bool:
        """Tell whether any process has a job."""
        return bool(self._running)

    def submit(self, job: Job) -> None:
        """Give a job to an idle process, or to a new one."""
        self._start(job, attempt=1)

    def wait(self) -> Finding:
        """Return the next finding; a job whose process died gets one more."""
        while True:
            future = self._finished.get()
            run = self._running.pop(future)
            try:
                finding = future.result()
            except BrokenProcessPool:
                run.pool.shutdown()
                if run.attempt == ATTEMPTS:
                    return lost(run.job, ATTEMPTS)
                self._start(run.job, attempt=run.attempt + 1)
                continue
            except Exception as error:
                finding = Finding(device=run.job.device, error=one_line(repr(error)))
            self._idle.append(run.pool)
            return finding

    def _start(self, job: Job, attempt: int) -> None:
        while True:
            pool = self._idle.pop() if self._idle else self._new_pool()
            try:
                future = pool.submit(self._work, job)
            except BrokenProcessPool:  # It died while it had nothing to do.
                pool.shutdown()
                continue
            self._running[future] = _Run(job=job, pool=pool, attempt=attempt)
            future.add_done_callback(self._finished.put)
            return

    def _new_pool(self) -> ProcessPoolExecutor:
        return ProcessPoolExecutor(
            max_workers=1,
            mp_context=self._context,
            initializer=_begin,
            initargs=(self._lifeline,),
        )


def _begin(lifeline: Connection) -> None:
    """Set up a process: an interrupt is the parent's affair, and the parent's end is its own."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, args=(lifeline,), daemon=True).start()


def _end_with_parent(lifeline: Connection) -> None:
    """Wait until the other end is closed, which a killed parent does too, and leave at once."""
    try:
        lifeline.poll(None)
    finally:
        os._exit(1)
