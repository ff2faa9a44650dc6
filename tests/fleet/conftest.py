"""Fleets, and a real Dask cluster on this machine."""

import contextlib
import json
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))  # Worker processes import fleet_work by its name.

from fleet_work import make_fleet  # noqa: E402

from hostkit.cli.main import run  # noqa: E402


@pytest.fixture
def fleet(tmp_path: Path) -> Path:
    """Four devices, six recordings."""
    return make_fleet(tmp_path / "fleet", 4)


@pytest.fixture
def call(monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]):
    """Run the command; gives exit code, standard output, standard error."""

    def run_command(*arguments: str | Path) -> tuple[int, str, str]:
        code = run(["tune", "--fleet", *map(str, arguments), "--iterations", "5"])
        out, err = capfd.readouterr()
        return code, out, err

    return run_command


@contextlib.contextmanager
def dask(folder: Path, *arguments: str) -> Iterator[subprocess.Popen[bytes]]:
    """Run a Dask program until the block ends."""
    environment = os.environ | {
        "PYTHONPATH": os.pathsep.join((str(HERE), *sys.path)),
        "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": "1",
    }
    command = [sys.executable, "-m", "dask", *arguments]
    with (folder / f"{arguments[0]}.log").open("ab") as log:
        program = subprocess.Popen(
            command, cwd=folder, env=environment, stdout=log, stderr=subprocess.STDOUT
        )
    try:
        yield program
    finally:
        program.terminate()
        try:
            program.wait(timeout=10)
        except subprocess.TimeoutExpired:
            program.kill()
            program.wait()


@contextlib.contextmanager
def scheduler(folder: Path) -> Iterator[tuple[str, subprocess.Popen[bytes]]]:
    """Run a scheduler on a free loopback port; gives its address and its process."""
    file = folder / "scheduler.json"
    options = ("--host", "127.0.0.1", "--port", "0", "--no-dashboard")
    with dask(folder, "scheduler", *options, "--scheduler-file", str(file)) as program:
        address = ""
        deadline = time.monotonic() + 20
        while not address:
            assert time.monotonic() < deadline, (folder / "scheduler.log").read_text()
            time.sleep(0.05)
            with contextlib.suppress(OSError, ValueError):
                address = json.loads(file.read_text())["address"]
        yield address, program


@contextlib.contextmanager
def worker(folder: Path, address: str) -> Iterator[subprocess.Popen[bytes]]:
    """Run a worker with its nanny."""
    options = ("--nthreads", "1", "--host", "127.0.0.1", "--no-dashboard")
    with dask(folder, "worker", address, *options, "--local-directory", str(folder)) as program:
        yield program


@pytest.fixture(scope="session")
def cluster_address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    pytest.importorskip("distributed")
    folder = tmp_path_factory.mktemp("dask")
    with scheduler(folder) as (address, _), worker(folder, address), worker(folder, address):
        yield address


@pytest.fixture
def cluster(cluster_address: str) -> str:
    """Address of a scheduler with two workers, also where a test before killed one."""
    import distributed

    with distributed.Client(cluster_address, timeout=20, set_as_default=False) as client:
        client.wait_for_workers(2, timeout=30)
    return cluster_address
