import math
import socket
import threading
from dataclasses import replace
from pathlib import Path

import pytest
from designs import design
from device import Device

from hostkit.errors import DeviceError, HostkitError
from hostkit.link.logs.tlog import CHUNK_BYTES, TlogWriter, read_tlog
from hostkit.link.ports.transport import Transport, open_transport
from hostkit.monitor import Session, SessionResult
from hostkit.monitor.snapshot import Batch, Snapshot
from hostkit.validation import Thresholds

SAMPLES = 200
READ_S = 0.125
LIMIT_S = 30.0
D = design()


class FakeClock:
    def __init__(self) -> None:
        self.now = 0.0

    def monotonic(self) -> float:
        return self.now

    def time(self) -> float:
        return 1.7e9 + self.now


class FakePort:
    """Gives its chunks one a read, each taking an eighth of a second, then silence or the end."""

    def __init__(
        self, clock: FakeClock, chunks: list[bytes], *, live: bool = True, ends: bool = False
    ):
        self.clock, self.chunks, self.live, self.ends = clock, list(chunks), live, ends
        self.state, self.epoch, self.overrun_bytes = "connected", 0, 0
        self.sent: list[bytes] = []

    def read(self, timeout_s: float) -> bytes | None:
        self.clock.now += READ_S
        if self.chunks:
            return self.chunks.pop(0)
        return None if self.ends else b""

    def write(self, data: bytes) -> None:
        self.sent.append(data)

    def close(self) -> None:
        pass


def session(chunks: list[bytes], *, live: bool = True, ends: bool = False, **options) -> Session:
    clock = FakeClock()
    port = FakePort(clock, chunks, live=live, ends=ends)
    return Session(design=D, transport=port, thresholds=Thresholds(), clock=clock, **options)


def test_a_device_that_does_not_tell_its_other_parameters_fails() -> None:
    retuned = Device(D).module.HOSTKIT_SAMPLE_RETUNED
    report = session(Device(D).frames(SAMPLES, flags=retuned), live=False, ends=True).run().report
    assert (report.verdict, report.digest_ok, report.checked) == ("fail", True, 0)
    assert any("other parameters" in reason for reason in report.reasons)


def test_file_is_judged_to_its_end() -> None:
    result = session(Device(D).frames(SAMPLES), live=False, ends=True).run()
    assert (result.report.verdict, result.report.samples) == ("pass", SAMPLES)


def test_duration_counts_from_the_first_sample() -> None:
    silence = [b""] * 20
    result = session(silence + Device(D).frames(SAMPLES), duration_s=5.0).run()
    assert result.duration_s == 5.0
    assert result.report.samples == 5.0 / READ_S + 1


def test_other_design_is_refused_at_once() -> None:
    other = Device(design(eta=0.9964))
    result = session(other.frames(SAMPLES)).run()
    assert result.report.verdict == "refused"
    assert not result.report.digest_ok
    assert other.digest in result.report.reasons[0]
    assert result.report.samples == 0


@pytest.mark.parametrize(
    ("chunks", "says"),
    [
        ([], "nothing was received"),
        ([b"roll=1.25 pitch=0.50\r\n"] * 9, "text, not MAVLink"),
        ([bytes(range(0, 250, 7)) * 3], "baud"),
        (Device(D).frames(0), "no TILT_SAMPLE"),
    ],
)
def test_silence_is_explained(chunks: list[bytes], says: str) -> None:
    with pytest.raises(DeviceError, match=says) as error:
        session(chunks).run()
    assert error.value.exit_code == 4


def test_status_text_of_a_refusing_device_is_shown() -> None:
    device = Device(D)
    text = device.module.MAVLink_statustext_message(2, b"MPU-6050 refused: WHO_AM_I is 0x12")
    with pytest.raises(DeviceError, match="WHO_AM_I is 0x12"):
        session([*device.frames(0), device._pack(text)]).run()


def test_device_that_stops_or_goes_away_is_an_error() -> None:
    with pytest.raises(DeviceError, match="stopped sending after 200 samples"):
        session(Device(D).frames(SAMPLES)).run()
    with pytest.raises(DeviceError, match="went away after 200 samples"):
        session(Device(D).frames(SAMPLES), ends=True).run()


def test_recorded_tlog_is_judged_the_same(tmp_path: Path) -> None:
    path = tmp_path / "flight.tlog"
    recorder = TlogWriter(path)
    frames = Device(D).frames(SAMPLES)
    first = session(frames, live=False, ends=True, recorders=[recorder]).run()
    recorder.close()
    assert list(read_tlog(path)) == frames
    port = open_transport(f"file:{path}", 0)
    again = Session(design=D, transport=port, thresholds=Thresholds()).run()
    assert again.report.rms_rad == pytest.approx(first.report.rms_rad, rel=1e-9)
    same = {"rms_rad": None, "residual": ()}
    assert replace(again.report, **same) == replace(first.report, **same)


def test_pymavlink_reads_our_tlog(tmp_path: Path) -> None:
    from hostkit.dialect import python_module

    path = tmp_path / "flight.tlog"
    recorder = TlogWriter(path)
    for k, frame in enumerate(Device(D).frames(20)):
        recorder.write(1_700_000_000_000_000 + k, frame)
    recorder.close()
    parser = python_module().MAVLink(None)
    content = path.read_bytes()
    assert int.from_bytes(content[:8], "big") == 1_700_000_000_000_000
    assert parser.parse_char(content[8 : 8 + len(Device(D).frames(0)[0])]).get_type() == "HEARTBEAT"


@pytest.mark.parametrize("content", [b"", b"short", bytes(500), b"time_s,gyro\n" * 50])
def test_what_is_no_tlog_is_refused(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "x.tlog"
    path.write_bytes(content)
    with pytest.raises(DeviceError, match="not a tlog"):
        list(read_tlog(path))


def test_damaged_tlog_gives_the_rest(tmp_path: Path) -> None:
    path = tmp_path / "x.tlog"
    frames = Device(D).frames(50)
    good = [bytes(8) + frame for frame in frames]
    path.write_bytes(b"".join(good[:20]) + b"\x07" * 33 + b"".join(good[20:]) + good[0][:15])
    assert set(read_tlog(path)) >= set(frames[:20]) | set(frames[21:])


@pytest.mark.parametrize("filler", [b"\x00", b"\xfd\xff\xff", b"\xfe\xff"])
def test_large_damage_is_passed_over(filler: bytes, tmp_path: Path) -> None:
    """After three chunks of rubbish frames are found again within 1 KiB.

    A false frame swallows up to 280 bytes, and what is left of it may look like the next.
    """
    path = tmp_path / "x.tlog"
    frames = Device(D).frames(50)
    good = b"".join(bytes(8) + frame for frame in frames)
    rubbish = filler * (3 * CHUNK_BYTES // len(filler))
    path.write_bytes(good + rubbish + good)
    found = list(read_tlog(path))
    assert found[:51] == frames
    kept = len(frames) - 1024 // (8 + min(map(len, frames[1:])))
    assert found[-kept:] == frames[-kept:]


@pytest.mark.parametrize(
    ("port", "says"),
    [
        ("/dev/does-not-exist", "does not exist"),
        ("tcp:nowhere", "HOST:PORT"),
        ("tcp:127.0.0.1:1", "cannot be reached"),
        ("udp:127.0.0.1:99999", "HOST:PORT"),
        ("file:/nonexistent.tlog", "cannot be read"),
    ],
)
def test_impossible_port_is_one_clear_error(port: str, says: str) -> None:
    with pytest.raises(DeviceError, match=says):
        open_transport(port, 500_000)


def test_unwritable_record_is_one_clear_error(tmp_path: Path) -> None:
    with pytest.raises(HostkitError, match="cannot be written"):
        TlogWriter(tmp_path / "missing" / "x.tlog")
    with pytest.raises(HostkitError, match="no file"):
        TlogWriter(Path("/dev/null"))


class Enough:
    """A view that ends the session when all samples came, however long they took."""

    def __init__(self) -> None:
        self.session: Session | None = None
        self.samples = 0

    def take_batch(self, batch: Batch) -> None:
        self.samples += len(batch)
        if self.samples >= SAMPLES and self.session is not None:
            self.session.stop()

    def take_snapshot(self, snapshot: Snapshot) -> None:
        pass


def run_until_all_came(port: Transport) -> SessionResult:
    enough = Enough()
    enough.session = Session(
        design=D, transport=port, thresholds=Thresholds(), duration_s=LIMIT_S, views=[enough]
    )
    return enough.session.run()


def test_tcp_device() -> None:
    frames = Device(D).frames(SAMPLES)
    with socket.create_server(("127.0.0.1", 0)) as server:
        number = server.getsockname()[1]

        def send() -> None:
            connection, _ = server.accept()
            with connection:
                connection.sendall(b"".join(frames))
                while connection.recv(4096):
                    pass

        thread = threading.Thread(target=send, daemon=True)
        thread.start()
        port = open_transport(f"tcp:127.0.0.1:{number}", 0)
        result = run_until_all_came(port)
        port.close()
        thread.join(timeout=LIMIT_S)
    assert (result.report.verdict, result.report.samples) == ("pass", SAMPLES)
    assert math.degrees(result.report.max_rad) < 0.005


def test_udp_device() -> None:
    frames = Device(D).frames(SAMPLES)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        number = probe.getsockname()[1]
    port = open_transport(f"udp:127.0.0.1:{number}", 0)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        for i in range(0, len(frames), 10):
            sender.sendto(b"".join(frames[i : i + 10]), ("127.0.0.1", number))
    result = run_until_all_came(port)
    port.close()
    assert (result.report.verdict, result.report.samples) == ("pass", SAMPLES)
