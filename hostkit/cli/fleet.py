"""Behind ``tune --fleet``: one design for each device of a folder."""

import os
import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import Any, TypeVar

import click

from hostkit.cli.inputs import say
from hostkit.cli.output import emit_json
from hostkit.errors import FleetError
from hostkit.fleet import (
    GROUP_RULES,
    SUMMARY,
    ClusterWorkers,
    DeviceResult,
    FleetOptions,
    FleetResult,
    LocalWorkers,
    Step,
    fleet_document,
    tune_fleet,
)

NAMED_IN_ERROR = 5
"""Devices that the last line names; all are in the summary."""

Function = TypeVar("Function", bound=Callable[..., Any])

JOBS = click.option(
    "--jobs",
    type=click.IntRange(1, 4096),
    metavar="N",
    help="Threads over recordings and restarts, by default 1; with --fleet processes, by default "
    "one for each core.",
)
SCHEDULER = click.option(
    "--scheduler",
    metavar="ADDRESS",
    help="With --fleet: a Dask scheduler whose workers do the work, such as tcp://HOST:8786.",
)
GROUP_BY = click.option(
    "--group-by",
    type=click.Choice(GROUP_RULES),
    default="folder",
    show_default=True,
    help="With --fleet: a device is a sub-folder, or the files of one prefix up to '_'.",
)
REDO = click.option(
    "--redo",
    is_flag=True,
    help="With --fleet: tune what is unchanged too, and replace designs that were edited.",
)


def fleet_options(function: Function) -> Function:
    """Give a command the options ``jobs``, ``scheduler``, ``group_by`` and ``redo``."""
    decorated: Function = JOBS(SCHEDULER(GROUP_BY(REDO(function))))
    return decorated


def run(
    folder: Path,
    output: Path,
    options: FleetOptions,
    *,
    jobs: int | None,
    scheduler: str | None,
    report_file: Path | None,
    as_json: bool,
) -> None:
    """Tune a fleet, show how it goes, and say at the end how it went.

    Parameters
    ----------
    folder, output
        Recordings, and where designs and the summary go.
    jobs, scheduler
        Local processes, or the address of a Dask scheduler; None for one process a core.
    report_file
        Where an overview goes as HTML, if anywhere.

    Raises
    ------
    FleetError
        If any device failed; the others are done.
    HostkitError
        If the fleet cannot be read or written, or the scheduler cannot be used.
    """
    if jobs is not None and scheduler is not None:
        raise click.UsageError("--jobs is for this machine; a scheduler knows its own workers")
    progress = Progress(clock=time.monotonic, on_terminal=sys.stderr.isatty())
    with progress, _terminable(), _workers(folder, jobs, scheduler) as workers:
        result = tune_fleet(folder, output, options, workers, progress.show)
    progress.finish(result)
    if report_file is not None:
        from hostkit.report.fleet import write_fleet_report

        write_fleet_report(result, report_file)
    if as_json:
        emit_json(fleet_document(result))
    else:
        _show(result, output)
    _require_success(result, output)


def _workers(
    folder: Path, jobs: int | None, scheduler: str | None
) -> AbstractContextManager[LocalWorkers | ClusterWorkers]:
    if scheduler is not None:
        return ClusterWorkers(address=scheduler, folder=folder)
    return LocalWorkers(jobs=jobs or _cores())


def _cores() -> int:
    """Return how many cores this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


@contextmanager
def _terminable() -> Iterator[None]:
    """Make SIGTERM an interrupt, so that workers are ended and no half-written file stays."""

    def interrupt(number: int, frame: object) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGTERM, interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


class Progress:
    """Says how a fleet goes: a counter on a terminal, else a line for each device."""

    def __init__(self, *, clock: Callable[[], float], on_terminal: bool) -> None:
        self._clock = clock
        self._begun_s = clock()
        self._on_terminal = on_terminal
        self._failed = 0
        self._counter = False

    def __enter__(self) -> "Progress":
        return self

    def __exit__(self, *reason: object) -> None:
        """End the line of the counter, also where the fleet was interrupted."""
        if self._counter:
            say("")

    def show(self, step: Step) -> None:
        """Show that a device is done; what was skipped is only counted."""
        failed = step.result.status == "failed"
        self._failed += failed
        if self._on_terminal:
            line = f"{_line(step)}\n" if failed else ""
            counter = f"{step.done}/{step.total} devices, {self._failed} failed"
            click.echo(f"\r\x1b[K{line}{counter}", err=True, nl=False)
            self._counter = True
        elif step.result.status != "skipped":
            say(f"{step.done}/{step.total} {_line(step)}")

    def finish(self, result: FleetResult) -> None:
        """Show how long it took."""
        took_s = self._clock() - self._begun_s
        say(f"{len(result.devices)} devices in {took_s:.1f} s")


def _line(step: Step) -> str:
    result = step.result
    took = "" if step.seconds is None else f" ({step.seconds:.2f} s)"
    remarks = "".join(f"; {remark}" for remark in step.remarks)
    return f"{result.device}: {result.error or _figures(result)}{remarks}{took}"


def _figures(result: DeviceResult) -> str:
    parts = [
        *(fact.text() for fact in result.facts),
        "" if result.rmse_deg is None else f"RMSE {result.rmse_deg:.4f} deg",
    ]
    return ", ".join(part for part in parts if part)


def _show(result: FleetResult, output: Path) -> None:
    click.echo(
        f"{len(result.of('ok'))} tuned, {len(result.of('skipped'))} unchanged, "
        f"{len(result.of('failed'))} failed\n{output / SUMMARY}"
    )


def _require_success(result: FleetResult, output: Path) -> None:
    failed = result.of("failed")
    if not failed:
        return
    names = ", ".join(device.device for device in failed[:NAMED_IN_ERROR])
    more = ", ..." if len(failed) > NAMED_IN_ERROR else ""
    raise FleetError(
        f"{len(failed)} of {len(result.devices)} devices failed: {names}{more}; "
        f"{output / SUMMARY} says why"
    )
