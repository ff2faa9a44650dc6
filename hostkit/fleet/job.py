"""What a worker does: load the recordings of one device, tune, and send the design back."""

import os
import time
import traceback
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from hostkit.errors import HostkitError
from hostkit.fleet.records import Finding, Job, one_line
from hostkit.recordings import Recording, check, load
from hostkit.records import FilterDesign, SensorConfig
from hostkit.tuning import TuningResult, sensor_config, tune

Work = Callable[[Job], Finding]
"""What is run for each device, in another process: a function of a module, not a closure."""


def tune_device(job: Job, clock: Callable[[], float] = time.perf_counter) -> Finding:
    """Tune one device; whatever goes wrong with it becomes the finding's error.

    A defect of the program is caught too, with the place where it happened: one device shall not
    end the others. Paths in the error are relative to the fleet's folder.
    """
    begun = clock()
    design: FilterDesign | None = None
    remarks: tuple[str, ...] = ()
    error = ""
    try:
        design, remarks = _tuned(job)
    except HostkitError as fault:
        error = str(fault)
    except Exception as fault:
        error = _crash(fault)
    return Finding(
        device=job.device,
        design=design,
        error=one_line(error.replace(f"{job.folder}{os.sep}", "")),
        remarks=remarks,
        seconds=clock() - begun,
    )


def _tuned(job: Job) -> tuple[FilterDesign, tuple[str, ...]]:
    recordings = tuple(load(path) for path in job.files)
    result = tune(recordings, replace(job.tuning, sensor=_sensor(job, recordings)))
    return result.design, _remarks(result, recordings)


def _sensor(job: Job, recordings: tuple[Recording, ...]) -> SensorConfig:
    if job.tuning.sensor is not None:
        return job.tuning.sensor
    return sensor_config(
        recordings,
        recordings[0].rate_hz,
        gyro_full_scale_deg_s=job.wish.gyro_full_scale_deg_s,
        accel_full_scale_g=job.wish.accel_full_scale_g,
        low_pass_setting=job.wish.low_pass_setting,
    )


def _remarks(result: TuningResult, recordings: tuple[Recording, ...]) -> tuple[str, ...]:
    """Return what deserves a second look; the cards themselves are shown by `hostkit tune`."""
    found = sum(len(check(recording).findings) for recording in recordings)
    remarks = [f"{found} finding(s) on the sanity cards"] if found else []
    if result.swarm.at_bound.any():
        remarks.append("a parameter lies on the edge of its range")
    return tuple(remarks)


def _crash(error: Exception) -> str:
    place = traceback.extract_tb(error.__traceback__)[-1]
    return f"{type(error).__name__}: {error} ({Path(place.filename).name}:{place.lineno})"
