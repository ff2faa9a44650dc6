"""The cable of the tests: what goes in comes out, until it is pulled."""

import contextlib
import os
import select
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from relay import Relay, relay

from hostkit.emulation.pty_server import PtyPort

PATIENCE_S = 10.0


@pytest.fixture
def device() -> Iterator[PtyPort]:
    port = PtyPort()
    with contextlib.closing(port):
        yield port


@pytest.fixture
def cable(device: PtyPort, tmp_path: Path) -> Iterator[Relay]:
    with relay(device.path, tmp_path / "link") as cable:
        yield cable


@contextlib.contextmanager
def reader(path: Path) -> Iterator[int]:
    descriptor = os.open(path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
    try:
        yield descriptor
    finally:
        os.close(descriptor)


def received(descriptor: int, size: int) -> bytes:
    data, deadline = b"", time.monotonic() + PATIENCE_S
    while len(data) < size and time.monotonic() < deadline:
        if select.select([descriptor], [], [], 0.1)[0]:
            data += os.read(descriptor, size)
    return data


def told(device: PtyPort, size: int) -> bytes:
    data, deadline = b"", time.monotonic() + PATIENCE_S
    while len(data) < size and time.monotonic() < deadline:
        device.listening()
        data += device.receive()
        select.select([], [], [], 0.01)
    return data


def test_bytes_pass_both_ways(device: PtyPort, cable: Relay) -> None:
    said = bytes(range(256)) * 64
    with reader(cable.path) as descriptor:
        device.send(said[:3000])
        assert received(descriptor, 3000) == said[:3000]
        os.write(descriptor, said[:256])
        assert told(device, 256) == said[:256]


def test_a_pulled_cable_ends_the_reader_and_comes_back_under_its_name(
    device: PtyPort, cable: Relay
) -> None:
    with reader(cable.path) as descriptor:
        cable.unplug()
        with contextlib.suppress(OSError):  # a pseudo-terminal that went away: EIO, or the end
            assert os.read(descriptor, 1) == b""
        assert not cable.path.exists()
        device.send(b"nobody hears this")
    deadline = time.monotonic() + PATIENCE_S
    while cable.lost_bytes < 17 and time.monotonic() < deadline:
        time.sleep(0.01)
    assert cable.lost_bytes == 17
    cable.plug()
    with reader(cable.path) as descriptor:
        device.send(b"again")
        assert received(descriptor, 5) == b"again"


def test_what_passes_can_be_disturbed(device: PtyPort, cable: Relay) -> None:
    cable.disturb = lambda data: data.replace(b"a", b"")
    with reader(cable.path) as descriptor:
        device.send(b"banana!")
        assert received(descriptor, 4) == b"bnn!"
