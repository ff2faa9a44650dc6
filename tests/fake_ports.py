"""Ports for tests: a pseudo-terminal with a plug, a port with a bit rate, a clock to be turned."""

import os
import time
import tty
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

from hostkit.errors import DeviceError
from hostkit.link.ports.finder import PortInfo

LIMIT_S = 20.0


def wait_until(condition: Callable[[], object], limit_s: float = LIMIT_S) -> None:
    end_s = time.monotonic() + limit_s
    while not condition():
        assert time.monotonic() < end_s, "it did not come about"
        time.sleep(0.002)


def read_until(port, condition: Callable[[bytes], bool], limit_s: float = LIMIT_S) -> bytes:
    got, end_s = b"", time.monotonic() + limit_s
    while not condition(got):
        assert time.monotonic() < end_s, f"only {len(got)} bytes came"
        got += port.read(0.05) or b""
    return got


class FakeClock:
    """Time that passes only when somebody sleeps."""

    def __init__(self) -> None:
        self.now_s = 100.0
        self.slept: list[float] = []

    def monotonic(self) -> float:
        return self.now_s

    def time(self) -> float:
        return 1.7e9 + self.now_s

    def sleep(self, duration_s: float) -> None:
        self.slept.append(duration_s)
        self.now_s += duration_s


class Cable:
    """A pseudo-terminal behind a link that keeps its name when it is plugged in again."""

    def __init__(self, folder: Path, name: str = "ttyFAKE0") -> None:
        self.path = folder / name
        self._master = -1
        self.plug()

    def plug(self) -> None:
        self._master, slave = os.openpty()
        tty.setraw(slave)
        os.set_blocking(self._master, False)
        self.real = os.ttyname(slave)
        self.path.unlink(missing_ok=True)
        self.path.symlink_to(self.real)
        os.close(slave)

    def unplug(self, *, keep_name: bool = False) -> None:
        os.close(self._master)
        if not keep_name:
            self.path.unlink()

    def send(self, data: bytes) -> None:
        end_s = time.monotonic() + LIMIT_S
        while data:
            assert time.monotonic() < end_s, "the port takes nothing"
            try:
                data = data[os.write(self._master, data) :]
            except BlockingIOError:
                time.sleep(0.001)

    def received(self) -> bytes:
        try:
            return os.read(self._master, 65536)
        except OSError:
            return b""

    def close(self) -> None:
        self.unplug(keep_name=True)


class FakeTransport:
    """A live port that gives what it is told to; None is its end."""

    live = True
    overrun_bytes = 0
    epoch = 0
    state = "connected"

    def __init__(self, *chunks: bytes | None, then: bytes | None = b"") -> None:
        self.chunks = list(chunks)
        self.then = then
        self.written: list[bytes] = []
        self.closed = False

    def read(self, timeout_s: float) -> bytes | None:
        assert not self.closed, "read after it was closed"
        if self.chunks:
            return self.chunks.pop(0)
        if self.then == b"":
            time.sleep(min(timeout_s, 0.005))
        return self.then

    def write(self, data: bytes) -> None:
        self.written.append(data)

    def close(self) -> None:
        self.closed = True


class FakeOpener:
    """Opens the given ports one after the other; an error in their place is raised."""

    def __init__(self, *ports: FakeTransport | DeviceError) -> None:
        self.ports = list(ports)
        self.calls = 0

    def __call__(self) -> FakeTransport:
        self.calls += 1
        port = self.ports.pop(0) if len(self.ports) > 1 else self.ports[0]
        if isinstance(port, DeviceError):
            raise port
        return port


class RatedPort:
    """A port that sends at one bit rate; at another its bytes come out spoilt.

    Parameters
    ----------
    starts_after_s
        How long the device is silent first.
    """

    def __init__(
        self,
        clock: FakeClock,
        rate: int,
        stream: bytes,
        *,
        starts_after_s: float = 0.0,
        missing_rates: tuple[int, ...] = (),
    ) -> None:
        self._clock, self._rate, self._stream = clock, rate, stream
        self._begin_s = clock.now_s + starts_after_s
        self._missing = missing_rates
        self._at = 0
        self.baud = 0
        self.tried: list[int] = []

    def set_baud(self, baud: int) -> bool:
        if baud in self._missing:
            return False
        self.baud = baud
        self.tried.append(baud)
        return True

    def read(self, timeout_s: float) -> bytes | None:
        self._clock.sleep(timeout_s)
        if not self._stream or self._clock.now_s < self._begin_s:
            return b""
        count = max(1, int(self._rate / 10 * timeout_s))
        data = bytes(self._stream[(self._at + i) % len(self._stream)] for i in range(count))
        self._at = (self._at + count) % len(self._stream)
        if self.baud == self._rate:
            return data
        return bytes(
            (byte * 37 + self.baud // 100 + i * i) % 256 | 0x80 for i, byte in enumerate(data)
        )


def usb(device: str, vid: int, pid: int, serial_number: str | None = None) -> PortInfo:
    return PortInfo(device=device, vid=vid, pid=pid, serial_number=serial_number, candidate=True)


def found_by_pyserial(device: str, **fields: object) -> SimpleNamespace:
    """What pyserial's comports() gives for one port."""
    return SimpleNamespace(device=device, **fields)
