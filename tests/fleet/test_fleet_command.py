import json
import math
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import psutil
import pytest
from fleet_work import files_of, make_fleet, spoil

from hostkit.cli.fleet import Progress
from hostkit.design_file import edited_by_hand
from hostkit.filters.filter import Fact
from hostkit.fleet import FleetResult, Step
from hostkit.fleet.records import DeviceResult


def test_a_fleet_and_its_second_run(call, fleet: Path, tmp_path: Path) -> None:
    output = tmp_path / "out"
    code, out, err = call(fleet, "-o", output, "--jobs", "2")
    assert (code, out.splitlines()) == (
        0,
        ["4 tuned, 0 unchanged, 0 failed", str(output / "fleet.json")],
    )
    lines = err.splitlines()
    assert sorted(line.split()[1] for line in lines[:4]) == [f"dev00{i}:" for i in range(4)]
    assert lines[0].startswith("1/4 dev00")
    assert all(word in lines[0] for word in ("eta 0.", "tau ", "RMSE ", " s)"))
    assert lines[4].startswith("4 devices in ")
    code, out, err = call(fleet, "-o", output, "--json")
    document = json.loads(out)
    assert (code, document["schema"], document["skipped"]) == (0, "hostkit.fleet/1", 4)
    assert document == json.loads((output / "fleet.json").read_text())
    assert len(err.splitlines()) == 1


def test_the_summary_tells_of_each_device_what_its_design_says(
    call, fleet: Path, tmp_path: Path
) -> None:
    call(fleet, "-o", tmp_path / "out", "--jobs", "1")
    text = (tmp_path / "out" / "fleet.json").read_text()
    for entry in json.loads(text)["devices"]:
        path = tmp_path / "out" / f"{entry['device']}.json"
        design = json.loads(path.read_text())
        eta = design["parameters"]["eta"]["value"]
        assert entry == {
            "device": entry["device"],
            "status": "ok",
            "recordings": len(design["tuning"]["recordings"]),
            "digest": design["digest"],
            "eta": eta,
            "tau_s": pytest.approx(0.01 * eta / (1.0 - eta)),
            "crossover_hz": pytest.approx((1.0 - eta) / (0.01 * eta * 2.0 * math.pi)),
            "rmse_deg": design["tuning"]["rmse_deg"],
            "error": None,
        }


def test_failures_end_in_exit_code_1_and_name_the_devices(
    call, fleet: Path, tmp_path: Path
) -> None:
    spoil(fleet, "dev001")
    code, out, err = call(fleet, "-o", tmp_path / "out", "--jobs", "1")
    assert (code, out.splitlines()[0]) == (1, "3 tuned, 0 unchanged, 1 failed")
    assert "dev001: run0 has no reference" in err
    assert err.splitlines()[-1] == (
        f"hostkit: 1 of 4 devices failed: dev001; {tmp_path / 'out' / 'fleet.json'} says why"
    )


def test_files_of_one_folder(call, fleet: Path, tmp_path: Path) -> None:
    flat = tmp_path / "flat"
    flat.mkdir()
    for path in fleet.rglob("*.npz"):
        path.rename(flat / f"{path.parent.name}_{path.name}")
    code, out, _ = call(flat, "-o", tmp_path / "out", "--group-by", "prefix", "--jobs", "1")
    assert (code, out.splitlines()[0]) == (0, "4 tuned, 0 unchanged, 0 failed")
    assert call(flat, "-o", tmp_path / "out")[0] == 1


def test_a_machine_and_a_scheduler_at_once_is_wrong_use(call, fleet: Path, tmp_path: Path) -> None:
    code, _, err = call(fleet, "-o", tmp_path / "o", "--jobs", "2", "--scheduler", "tcp://h:1")
    assert (code, "--jobs is for this machine" in err) == (2, True)


def test_a_scheduler_on_the_command_line(call, cluster: str, fleet: Path, tmp_path: Path) -> None:
    code, out, err = call(fleet, "-o", tmp_path / "out", "--scheduler", cluster)
    assert (code, out.splitlines()[0]) == (0, "4 tuned, 0 unchanged, 0 failed"), err


def test_dask_missing_is_exit_code_5(
    call, fleet: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    code, _, err = call(fleet, "-o", tmp_path / "out", "--scheduler", "tcp://127.0.0.1:1")
    assert (code, "hostkit[fleet]" in err) == (5, True)


def test_the_report_names_every_device(call, fleet: Path, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    spoil(fleet, "dev002")
    (fleet / "dev<b>3").mkdir()
    report = tmp_path / "fleet.html"
    call(fleet, "-o", tmp_path / "out", "--report", report, "--jobs", "1")
    text = report.read_text()
    devices = json.loads((tmp_path / "out" / "fleet.json").read_text())["devices"]
    for entry in devices:
        if entry["digest"]:
            assert f"<td>{entry['digest']}</td><td>{entry['eta']:.6g}</td>" in text
    assert text.count("<svg") == 4
    assert "run0 has no reference" in text
    assert "dev&lt;b&gt;3" in text
    assert "<b>3" not in text.replace("</small>", "").replace("<b>3</b>", "")


ETA = Fact(name="eta", label="eta", value=0.5)


def result(name: str, error: str = "") -> DeviceResult:
    status = "failed" if error else "ok"
    return DeviceResult(device=name, status=status, recordings=1, facts=(ETA,), error=error)


def test_a_terminal_has_a_counter_and_the_failures(capsys: pytest.CaptureFixture[str]) -> None:
    progress = Progress(clock=iter((1.0, 3.5)).__next__, on_terminal=True)
    with progress:
        progress.show(Step(result=result("good"), done=1, total=2, seconds=0.1))
        progress.show(Step(result=result("bad", "broken"), done=2, total=2, seconds=0.25))
    progress.finish(FleetResult(devices=(result("bad", "broken"), result("good"))))
    shown = capsys.readouterr().err.replace("\x1b[K", "").split("\r")
    assert shown == [
        "",
        "1/2 devices, 0 failed",
        "bad: broken (0.25 s)\n2/2 devices, 1 failed\n2 devices in 2.5 s\n",
    ]


def test_remarks_are_shown(capsys: pytest.CaptureFixture[str]) -> None:
    progress = Progress(clock=time.monotonic, on_terminal=False)
    progress.show(Step(result=result("d"), done=1, total=1, remarks=("look",), seconds=0.1))
    assert capsys.readouterr().err == "1/1 d: eta 0.5; look (0.10 s)\n"


@contextmanager
def running(fleet: Path, output: Path, designs: int) -> Iterator[subprocess.Popen[str]]:
    """Run the command with one process until it has written some designs."""
    arguments = (
        "tune",
        "--fleet",
        str(fleet),
        "-o",
        str(output),
        "--iterations",
        "5",
        "--jobs",
        "1",
    )
    with subprocess.Popen(
        [sys.executable, "-m", "hostkit", *arguments],
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        # A shell has the programs that it starts in the background ignore interrupts.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    ) as program:
        wait_until(lambda: len(list(output.glob("dev*.json"))) >= designs)
        yield program
        program.kill()


def wait_until(condition: Callable[[], bool]) -> None:
    deadline = time.monotonic() + 30.0
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.005)


def workers_of(program: subprocess.Popen[str]) -> list[psutil.Process]:
    return psutil.Process(program.pid).children(recursive=True)


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT], ids=lambda n: n.name)
def test_an_interrupted_run_ends_its_workers_and_leaves_whole_files(
    fleet: Path, tmp_path: Path, number: signal.Signals
) -> None:
    output = tmp_path / "out"
    with running(fleet, output, 1) as program:
        workers = workers_of(program)
        if number == signal.SIGINT:
            os.killpg(program.pid, number)  # A terminal interrupts the workers too.
        else:
            program.terminate()
        code = program.wait(timeout=10)
        said = program.stderr.read()
    assert workers
    wait_until(lambda: not any(worker.is_running() for worker in workers))
    assert (code, said.splitlines()[-1]) == (130, "hostkit: interrupted")
    assert "Traceback" not in said
    assert not any(edited_by_hand(path) for path in output.glob("dev*.json"))
    assert not (output / "fleet.json").exists()
    assert list(output.glob("*.part")) == []


def test_after_a_kill_the_next_run_goes_on(call, tmp_path: Path) -> None:
    fleet, output = make_fleet(tmp_path / "fleet", 16, duration_s=2.0), tmp_path / "out"
    with running(fleet, output, 2) as program:
        workers = workers_of(program)
        program.kill()
        program.wait(timeout=10)
    assert workers
    wait_until(lambda: not any(worker.is_running() for worker in workers))
    done = {path: path.stat().st_mtime_ns for path in output.glob("dev*.json")}
    assert 2 <= len(done) < 16
    assert not (output / "fleet.json").exists()
    code, out, _ = call(fleet, "-o", output)
    assert code == 0
    assert out.startswith(f"{16 - len(done)} tuned, {len(done)} unchanged, 0 failed")
    assert {path: path.stat().st_mtime_ns for path in done} == done
    call(fleet, "-o", tmp_path / "fresh")
    kept, fresh = files_of(output), files_of(tmp_path / "fresh")
    assert {**kept, "fleet.json": b""} == {**fresh, "fleet.json": b""}
