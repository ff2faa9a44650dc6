"""Tuning a fleet: feeding devices to workers, and writing each design as it comes."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from hostkit.design_file import digest, save_design
from hostkit.files import write_aside
from hostkit.fleet.discovery import find_devices
from hostkit.fleet.journal import Journal, fingerprint, open_journal
from hostkit.fleet.records import (
    Device,
    DeviceResult,
    Finding,
    FleetOptions,
    FleetResult,
    Job,
    Step,
    designed,
    failed,
)
from hostkit.fleet.resume import settled
from hostkit.fleet.summary import SUMMARY, fleet_text
from hostkit.fleet.workers import Workers

Watch = Callable[[Step], None]


def tune_fleet(
    folder: Path, output: Path, options: FleetOptions, workers: Workers, watch: Watch
) -> FleetResult:
    """Tune one design for each device of a folder.

    Writes ``DEVICE.json`` as devices finish and ``fleet.json`` at the end. Both depend on the
    recordings and the options only, not on the workers, their number or the order in which they
    finish. While a run is under way, or after one that was interrupted, there is no ``fleet.json``.

    Parameters
    ----------
    folder
        The recordings; see :func:`hostkit.fleet.discovery.find_devices`.
    output
        Where designs go; it is made if it is missing. One run at a time may write to it.
    workers
        What does the work, already entered.
    watch
        Is told of every device that is done.

    Raises
    ------
    RecordingError
        If the folder holds no device.
    HostkitError
        If the output cannot be written. A device that fails raises nothing: it is in the result.
    """
    folder, output = folder.resolve(), output.resolve()
    devices = find_devices(folder, options.group_by, leave_out=output)
    with open_journal(output) as journal:
        (output / SUMMARY).unlink(missing_ok=True)
        run = _Run(
            folder=folder,
            output=output,
            options=options,
            fingerprint=fingerprint(options.tuning, options.wish),
            journal=journal,
        )
        results = []
        for step in _steps(run, devices, workers):
            results.append(step.result)
            watch(step)
        result = FleetResult(devices=tuple(sorted(results, key=lambda found: found.device)))
        write_aside(output / SUMMARY, fleet_text(result))
    return result


@dataclass(frozen=True, slots=True, kw_only=True)
class _Run:
    folder: Path
    output: Path
    options: FleetOptions
    fingerprint: str
    journal: Journal

    def design_file(self, device: str) -> Path:
        return self.output / f"{device}.json"


def _steps(run: _Run, devices: tuple[Device, ...], workers: Workers) -> Iterator[Step]:
    results = _results(run, devices, workers)
    for done, (result, finding) in enumerate(results, start=1):
        yield Step(
            result=result,
            done=done,
            total=len(devices),
            remarks=() if finding is None else finding.remarks,
            seconds=None if finding is None else finding.seconds,
        )


def _results(
    run: _Run, devices: tuple[Device, ...], workers: Workers
) -> Iterator[tuple[DeviceResult, Finding | None]]:
    """Yield what is done; a worker has its next job before the design of its last is written."""
    counts = {device.name: len(device.files) for device in devices}
    for device in devices:
        known = settled(
            device,
            run.design_file(device.name),
            run.journal,
            fingerprint=run.fingerprint,
            redo=run.options.redo,
        )
        if known is not None:
            yield known, None
            continue
        finding = workers.wait() if workers.full() else None
        workers.submit(_job(run, device))
        if finding is not None:
            yield _accepted(run, finding, counts[finding.device]), finding
    while workers.busy():
        finding = workers.wait()
        yield _accepted(run, finding, counts[finding.device]), finding


def _job(run: _Run, device: Device) -> Job:
    return Job(
        device=device.name,
        folder=run.folder,
        files=device.files,
        tuning=run.options.tuning,
        wish=run.options.wish,
    )


def _accepted(run: _Run, finding: Finding, recordings: int) -> DeviceResult:
    """Remember the design of a finding, then write it."""
    if finding.design is None:
        return failed(finding.device, recordings, finding.error)
    run.journal.add(finding.device, digest(finding.design), run.fingerprint)
    save_design(finding.design, run.design_file(finding.device))
    return designed(finding.device, "ok", recordings, finding.design)
