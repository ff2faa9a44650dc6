import re
import sys
from pathlib import Path

import fleet_work
import pytest
from conftest import scheduler, worker
from fleet_work import QUICK, Inline, files_of, run_fleet, spoil

from hostkit.errors import SchedulerError, ToolMissingError
from hostkit.fleet import ClusterWorkers, SensorWish
from hostkit.fleet.job import tune_device
from hostkit.fleet.place import Place, place_here, unfit, work_there
from hostkit.fleet.records import Job
from hostkit.tuning.tune import versions

REACH_S = 20.0


def test_a_cluster_writes_the_same_bytes_as_this_machine(
    cluster: str, fleet: Path, tmp_path: Path
) -> None:
    spoil(fleet, "dev003")
    run_fleet(fleet, tmp_path / "here", Inline())
    with ClusterWorkers(address=cluster, folder=fleet, timeout_s=REACH_S) as workers:
        result = run_fleet(fleet, tmp_path / "there", workers)
    assert [device.status for device in result.devices] == ["ok", "ok", "ok", "failed"]
    assert files_of(tmp_path / "there") == files_of(tmp_path / "here")


def test_work_of_a_lost_worker_is_done_by_another_but_not_for_ever(
    cluster: str, fleet: Path, tmp_path: Path
) -> None:
    with ClusterWorkers(
        address=cluster, folder=fleet, work=fleet_work.trouble, timeout_s=REACH_S
    ) as workers:
        result = run_fleet(fleet, tmp_path / "out", workers)
    assert (fleet / "died").exists()
    assert [device.status for device in result.devices] == ["ok", "ok", "failed", "failed"]
    assert "its worker process died 2 times" in result.devices[2].error
    assert result.devices[3].error == "KeyError('dev003')"


def test_few_jobs_are_given_at_a_time(cluster: str, fleet: Path) -> None:
    with ClusterWorkers(address=cluster, folder=fleet, work=fleet_work.slow) as workers:
        given = 0
        while not workers.full():
            workers.submit(job(fleet, f"dev{given}"))
            given += 1
        assert given == 4
        assert {workers.wait().device for _ in range(4)} == {f"dev{i}" for i in range(4)}
        assert not workers.busy()


def job(folder: Path, device: str = "a") -> Job:
    return Job(device=device, folder=folder, files=(), tuning=QUICK, wish=SensorWish())


def test_workers_without_the_recordings_are_refused(cluster: str, fleet: Path) -> None:
    with (
        pytest.raises(SchedulerError, match=r"worker tcp://127.* does not see .*/elsewhere"),
        ClusterWorkers(address=cluster, folder=fleet / "elsewhere", timeout_s=REACH_S),
    ):
        pass


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"versions": (("hostkit", "0.0.1"),)}, r"has hostkit 0\.0\.1; .* needs hostkit"),
        ({"threads": ("1", None, "1")}, "several threads"),
        ({"sees_folder": False}, "does not see"),
        ({}, "^$"),
    ],
    ids=["versions", "threads", "folder", "fit"],
)
def test_a_worker_that_would_compute_something_else(changes, reason: str) -> None:
    place = Place(**{"versions": versions(), "threads": ("1",) * 3, "sees_folder": True, **changes})
    assert re.search(reason, unfit(place, versions(), Path("/fleet")))


def test_a_worker_that_joins_late_looks_at_itself(
    fleet: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
    finding = work_there(tune_device, job(fleet), versions())
    assert finding.error.startswith("its worker computes with several threads")
    for name in ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
        monkeypatch.setenv(name, "1")
    assert place_here(fleet).threads == ("1", "1", "1")
    assert work_there(fleet_work.threads, job(fleet), versions()).error == "threads 1"


def test_a_scheduler_that_is_not_there(fleet: Path) -> None:
    with (
        pytest.raises(SchedulerError, match=r"tcp://127\.0\.0\.1:1 cannot be reached") as caught,
        ClusterWorkers(address="tcp://127.0.0.1:1", folder=fleet, timeout_s=0.5),
    ):
        pass
    assert caught.value.exit_code == 4


@pytest.mark.parametrize("address", ["foo://host:1", "tcp://host", "host", ""])
def test_an_address_that_is_none(fleet: Path, address: str) -> None:
    with pytest.raises(SchedulerError, match="is no address of a scheduler"):
        ClusterWorkers(address=address, folder=fleet)


def test_a_scheduler_without_workers_and_one_that_is_lost(fleet: Path, tmp_path: Path) -> None:
    with scheduler(tmp_path) as (address, program):

        def connect(timeout_s: float) -> ClusterWorkers:
            return ClusterWorkers(
                address=address, folder=fleet, work=fleet_work.slow, timeout_s=timeout_s
            )

        with pytest.raises(SchedulerError, match="has no worker"), connect(0.5):
            pass
        with worker(tmp_path, address) as nanny, connect(REACH_S) as workers:
            workers._timeout_s = 1.0
            workers.submit(job(fleet))
            nanny.kill()
            with pytest.raises(SchedulerError, match="has had no worker for 1 s"):
                workers.wait()
            program.kill()
            with pytest.raises(SchedulerError, match=f"{address} was lost"):
                workers.wait()


def test_dask_is_an_extra(fleet: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(ToolMissingError, match=r"pip install 'hostkit\[fleet\]'"):
        ClusterWorkers(address="tcp://127.0.0.1:1", folder=fleet)
