"""What workers do in tests, and fleets for them; imported by worker processes too."""

import os
import signal
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from hostkit.design_file import digest, load_design, save_design
from hostkit.fleet import FleetOptions, FleetResult, LocalWorkers, Step, Workers, tune_fleet
from hostkit.fleet.job import tune_device
from hostkit.fleet.records import Finding, Job
from hostkit.recordings import Recording, save
from hostkit.records import SensorConfig
from hostkit.simulation import SensorErrors, simulate
from hostkit.tuning import TuningOptions

QUICK = TuningOptions(axes="roll", particles=5, iterations=5)
SENSOR = SensorConfig(
    part="mpu6050", gyro_full_scale_deg_s=500, accel_full_scale_g=4, low_pass_setting=3
)


def recorded(seed: int, *, duration_s: float = 3.0) -> Recording:
    return simulate(
        "steps",
        duration_s=duration_s,
        rate_hz=100.0,
        sensor=SENSOR,
        errors=SensorErrors(vibration_m_s2=2.0),
        rng=np.random.default_rng(seed),
    )


def make_fleet(folder: Path, devices: int, *, duration_s: float = 3.0) -> Path:
    """Devices ``dev000`` and so on; the odd ones have a second recording."""
    for i in range(devices):
        home = folder / f"dev{i:03}"
        home.mkdir(parents=True)
        for j in range(1 + i % 2):
            save(recorded(100 * i + j, duration_s=duration_s), home / f"run{j}.npz")
    return folder


def spoil(folder: Path, device: str) -> None:
    """Give a device a recording without a reference."""
    save(replace(recorded(7), up_reference=None), folder / device / "run0.npz")


def run_fleet(
    folder: Path,
    output: Path,
    workers: Workers | None = None,
    *,
    options: FleetOptions | None = None,
    watch=lambda step: None,
) -> FleetResult:
    options = options or FleetOptions(tuning=QUICK)
    if workers is not None:
        return tune_fleet(folder, output, options, workers, watch)
    with LocalWorkers(jobs=2) as local:
        return tune_fleet(folder, output, options, local, watch)


class Inline:
    """A back end in this process, which remembers how much it had to do."""

    def __init__(self, capacity: int = 3, work=tune_device) -> None:
        self.capacity, self.work = capacity, work
        self.given: list[str] = []
        self.most_waiting = 0
        self._waiting: list[Job] = []

    def full(self) -> bool:
        return len(self._waiting) >= self.capacity

    def busy(self) -> bool:
        return bool(self._waiting)

    def submit(self, job: Job) -> None:
        self.given.append(job.device)
        self._waiting.append(job)
        self.most_waiting = max(self.most_waiting, len(self._waiting))

    def wait(self) -> Finding:
        return self.work(self._waiting.pop())  # Last in, first out: not the order of the devices.


def files_of(output: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted(output.glob("*.json"))}


def edit(path: Path) -> str:
    """Halve eta as somebody with an editor would who also mends the digest."""
    design = load_design(path)
    parameters = tuple(
        replace(p, value=p.value / 2) if p.name == "eta" else p for p in design.parameters
    )
    edited = replace(design, parameters=parameters)
    save_design(edited, path)
    return digest(edited)


def collect_steps() -> tuple[list[Step], object]:
    steps: list[Step] = []
    return steps, steps.append


def trouble(job: Job) -> Finding:
    """Device 1 kills its process the first time, device 2 each time; device 3 raises."""
    marker = job.folder / "died"
    if job.device.endswith("2") or (job.device.endswith("1") and not marker.exists()):
        marker.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    if job.device.endswith("3"):
        raise KeyError(job.device)
    return tune_device(job)


def slow(job: Job) -> Finding:
    time.sleep(0.3)
    return tune_device(job)


def first_is_quick(job: Job) -> Finding:
    time.sleep(0.0 if job.device.endswith("0") else 30.0)
    return Finding(device=job.device, error="no")


def threads(job: Job) -> Finding:
    """Say in the error how this process may compute."""
    return Finding(device=job.device, error=f"threads {os.environ.get('OPENBLAS_NUM_THREADS')}")
