import hashlib
import json
import signal
import time
import tracemalloc
from collections.abc import Iterator
from pathlib import Path

import fleet_work
import psutil
import pytest
from fleet_work import Inline, collect_steps, files_of, make_fleet, run_fleet, spoil

from hostkit.design_file import load_design
from hostkit.fleet import LocalWorkers, SensorWish
from hostkit.fleet.records import Finding, Job
from hostkit.fleet.resume import _sha256
from hostkit.tuning import tune


def local_processes() -> list[psutil.Process]:
    """Return the processes that do work, which one server of this process has forked."""
    children = psutil.Process().children()
    servers = [child for child in children if "forkserver" in str(child.cmdline())]
    return [worker for server in servers for worker in server.children()]


@pytest.fixture(autouse=True)
def no_process_is_left() -> Iterator[None]:
    yield
    left = local_processes()
    assert left == []


def test_one_and_two_processes_and_any_order_write_the_same_bytes(
    fleet: Path, tmp_path: Path
) -> None:
    run_fleet(fleet, tmp_path / "inline", Inline())
    for jobs in (1, 2):
        with LocalWorkers(jobs=jobs) as workers:
            run_fleet(fleet, tmp_path / str(jobs), workers)
    assert len(files_of(tmp_path / "1")) == 5
    assert files_of(tmp_path / "1") == files_of(tmp_path / "2") == files_of(tmp_path / "inline")


def test_a_design_is_that_of_a_plain_tuning(fleet: Path, tmp_path: Path) -> None:
    from hostkit.recordings import load

    run_fleet(fleet, tmp_path / "out", Inline())
    files = sorted((fleet / "dev001").glob("*.npz"))
    plain = tune(tuple(load(path) for path in files), fleet_work.QUICK).design
    assert load_design(tmp_path / "out" / "dev001.json") == plain


def test_a_device_that_fails_does_not_stop_the_others(fleet: Path, tmp_path: Path) -> None:
    spoil(fleet, "dev001")
    (fleet / "dev002" / "bad.csv").write_text("time_s\n1\n")
    (fleet / "empty").mkdir()
    result = run_fleet(fleet, tmp_path / "out", Inline())
    assert [device.status for device in result.devices] == [
        "ok",
        "failed",
        "failed",
        "ok",
        "failed",
    ]
    errors = (
        [device.error for device in result.failed()]
        if hasattr(result, "failed")
        else [device.error for device in result.of("failed")]
    )
    assert errors[0].startswith("run0 has no reference")
    assert errors[1].startswith("dev002/bad.csv: ")
    assert "holds no recording" in errors[2]
    assert str(tmp_path) not in (tmp_path / "out" / "fleet.json").read_text()
    assert sorted(files_of(tmp_path / "out")) == ["dev000.json", "dev003.json", "fleet.json"]


def test_a_defect_of_the_program_is_told_with_its_place(
    fleet: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def defect(*arguments: object) -> None:
        raise ZeroDivisionError("first\nsecond")

    monkeypatch.setattr("hostkit.fleet.job.tune", defect)
    error = run_fleet(fleet, tmp_path / "out", Inline()).devices[0].error
    assert error.startswith("ZeroDivisionError: first second (test_fleet_local.py:")


def test_a_killed_process_is_forgiven_once_and_loses_its_device_only(
    fleet: Path, tmp_path: Path
) -> None:
    with LocalWorkers(jobs=2, work=fleet_work.trouble) as workers:
        result = run_fleet(fleet, tmp_path / "out", workers)
    assert (fleet / "died").exists()
    assert [device.status for device in result.devices] == ["ok", "ok", "failed", "failed"]
    assert "its worker process died 2 times" in result.devices[2].error
    assert result.devices[3].error == "KeyError('dev003')"


EMPTY = Job(device="a", folder=Path(), files=(), tuning=fleet_work.QUICK, wish=SensorWish())


def test_an_interrupt_from_the_terminal_does_not_reach_the_work() -> None:
    with LocalWorkers(jobs=1, work=fleet_work.slow) as workers:
        workers.submit(EMPTY)
        workers.wait()
        workers.submit(EMPTY)
        time.sleep(0.1)
        (process,) = local_processes()
        process.send_signal(signal.SIGINT)
        assert workers.wait().device == "a"
        assert local_processes() == [process]


def test_an_idle_process_that_is_killed_is_replaced() -> None:
    with LocalWorkers(jobs=1, work=fleet_work.threads) as workers:
        workers.submit(EMPTY)
        assert workers.wait().error == "threads 1"
        (process,) = local_processes()
        process.kill()
        time.sleep(0.3)
        workers.submit(EMPTY)
        assert workers.wait().error == "threads 1"


def test_processes_end_at_once_when_the_fleet_is_interrupted(fleet: Path, tmp_path: Path) -> None:
    def interrupt(step: object) -> None:
        raise KeyboardInterrupt

    begun = time.monotonic()
    workers = LocalWorkers(jobs=2, work=fleet_work.first_is_quick)
    with pytest.raises(KeyboardInterrupt), workers:
        run_fleet(fleet, tmp_path / "out", workers, watch=interrupt)
    assert time.monotonic() - begun < 20.0


def test_hundreds_of_devices_keep_the_number_of_waiting_jobs(tmp_path: Path) -> None:
    """With a back end that finishes last what was given first."""
    for i in range(300):
        (tmp_path / "fleet" / f"d{i:03}").mkdir(parents=True)
        (tmp_path / "fleet" / f"d{i:03}" / "r.csv").touch()
    workers = Inline(capacity=7, work=lambda job: Finding(device=job.device, error="no"))
    steps, watch = collect_steps()
    result = run_fleet(tmp_path / "fleet", tmp_path / "out", workers, watch=watch)
    assert workers.most_waiting == 7
    assert [step.done for step in steps] == list(range(1, 301))
    assert [device.device for device in result.devices] == [f"d{i:03}" for i in range(300)]
    document = json.loads((tmp_path / "out" / "fleet.json").read_text())
    assert (document["failed"], document["ok"]) == (300, 0)


def peak_bytes(fleet: Path, output: Path, workers: LocalWorkers) -> int:
    tracemalloc.start()
    run_fleet(fleet, output, workers)
    run_fleet(fleet, output, workers)  # The second time recordings are read for their digests.
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return peak


def test_memory_of_the_client_does_not_grow_with_recordings(tmp_path: Path) -> None:
    """Ten times longer recordings cost the client less than half of what one of them holds."""
    short = make_fleet(tmp_path / "short", 4, duration_s=4.0)
    long = make_fleet(tmp_path / "long", 4, duration_s=40.0)
    size = (long / "dev000" / "run0.npz").stat().st_size
    with LocalWorkers(jobs=1) as workers:
        fleets = (short, short, long)
        peaks = [peak_bytes(fleet, tmp_path / f"out-{fleet.name}", workers) for fleet in fleets]
    assert peaks[2] - peaks[1] < size / 2


def test_a_file_is_read_in_pieces_for_its_digest(tmp_path: Path) -> None:
    path = tmp_path / "large.npz"
    path.write_bytes(bytes(4 * 2**20))
    tracemalloc.start()
    assert _sha256(path) == hashlib.sha256(bytes(4 * 2**20)).hexdigest()
    tracemalloc.reset_peak()
    _sha256(path)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 2**20
