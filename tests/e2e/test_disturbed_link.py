"""A bad link under the real monitor: what was done to it is what is counted, and no more."""

import contextlib
import dataclasses
import json
import threading
from pathlib import Path

import pytest
from designs import design
from device import Device
from disturb import Disturber

from hostkit.cli.main import run
from hostkit.design_file import save_design
from hostkit.emulation.pty_server import PtyPort

SAMPLES, CHUNK_BYTES = 2000, 2048


def send(port: PtyPort, data: bytes) -> None:
    """Say everything once the reader has spoken: what comes while it opens the port it drops."""
    while not (port.listening() and port.receive()):
        threading.Event().wait(0.01)
    for begin in range(0, len(data), CHUNK_BYTES):
        port.send(data[begin : begin + CHUNK_BYTES])


@pytest.mark.parametrize("seed", [1, 2])
def test_the_counts_are_exact_and_no_step_is_called_wrong(
    seed: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    device, disturber = Device(design()), Disturber(seed)
    save_design(device.design, tmp_path / "design.json")
    data = disturber.disturb(device.frames(SAMPLES))
    with contextlib.closing(PtyPort()) as port:
        sender = threading.Thread(target=send, args=(port, data), daemon=True)
        sender.start()
        arguments = ["monitor", str(tmp_path / "design.json"), "--port", port.path, "--json"]
        arguments += ["--duration", "3", "--max-lost-percent", "100", "--baud", "500000"]
        code = run(arguments)
        sender.join(10.0)
    out, err = capsys.readouterr()
    found = json.loads(out)
    expected = dataclasses.asdict(disturber.expected())
    del expected["sources"]
    assert {name: found["link"][name] for name in expected} == expected
    arrived = {frame for frame in disturber.intact if frame[7:10] == b"\x52\xcb\x00"}
    assert found["samples"] == len(arrived)
    assert found["mismatches"] == 0
    assert found["checked"] > 0.8 * len(arrived)
    assert (code, found["verdict"]) == (0, "pass"), err
