"""The bit rate of a device, or what comes instead of MAVLink."""

import random

import pytest
from designs import design
from device import Device
from fake_ports import FakeClock, RatedPort

from hostkit.errors import DeviceError
from hostkit.link.ports.baud_scan import (
    LISTEN_S,
    RATES,
    START_S,
    readable_line,
    scan_baud,
    text_share,
)

DEVICE = Device(design())
STREAM = b"".join(DEVICE.frames(100))
TEXT = b"ax = -0.02 g\tay = 0.98 g\r\ntemperature 24.5 degC\r\n" * 20
NOISE = random.Random(3).randbytes(4000)


def frames_v1(count: int) -> bytes:
    mav = DEVICE.module.MAVLink(None, srcSystem=1, srcComponent=1)
    message = DEVICE.module.MAVLink_heartbeat_message(0, 0, 0, 0, 4, 3)
    return bytes(message.pack(mav, force_mavlink1=True)) * count


def scan(port: RatedPort, clock: FakeClock):
    return scan_baud(port, clock=clock)


@pytest.mark.parametrize("rate", RATES)
def test_every_usual_rate_is_found(rate: int) -> None:
    clock = FakeClock()
    port = RatedPort(clock, rate, STREAM)
    found = scan(port, clock)
    assert (found.finding, found.baud, port.baud) == ("mavlink2", rate, rate)
    assert (found.system, found.component, found.digest) == (1, 1, DEVICE.digest)
    assert port.tried == list(RATES[: RATES.index(rate) + 1])
    assert clock.now_s - 100.0 <= len(port.tried) * (LISTEN_S + 0.05) + 0.1
    assert found.required_baud("p") == rate
    assert DEVICE.digest in found.explain()


def test_board_that_is_still_in_its_boot_loader_is_waited_for() -> None:
    clock = FakeClock()
    found = scan(RatedPort(clock, 500_000, STREAM, starts_after_s=1.7), clock)
    assert (found.finding, found.baud) == ("mavlink2", 500_000)
    clock = FakeClock()
    found = scan(RatedPort(clock, 57_600, STREAM, starts_after_s=1.7), clock)
    assert (found.finding, found.baud) == ("mavlink2", 57_600)


def test_device_of_another_maker_has_no_digest() -> None:
    clock = FakeClock()
    found = scan(RatedPort(clock, 115_200, DEVICE.frames(0)[0]), clock)
    assert (found.finding, found.baud, found.digest) == ("mavlink2", 115_200, None)


def test_text_is_shown_at_its_rate() -> None:
    clock = FakeClock()
    found = scan(RatedPort(clock, 9600, TEXT), clock)
    assert (found.finding, found.baud) == ("text", 9600)
    assert found.sample in ("ax = -0.02 g\tay = 0.98 g", "ax = -0.02 g?ay = 0.98 g")
    with pytest.raises(DeviceError, match=r"text at 9600 bit/s, such as 'ax = -0\.02 g"):
        found.required_baud("/dev/ttyX")


def test_mavlink_1_is_told_from_2() -> None:
    clock = FakeClock()
    found = scan(RatedPort(clock, 57_600, frames_v1(50)), clock)
    assert (found.finding, found.baud) == ("mavlink1", 57_600)
    with pytest.raises(DeviceError, match="hostkit wants MAVLink 2"):
        found.required_baud("/dev/ttyX")


def test_unusual_rate_or_noise_is_bytes() -> None:
    for stream, rate in ((STREAM, 76_800), (NOISE, 115_200)):
        clock = FakeClock()
        found = scan(RatedPort(clock, rate, stream), clock)
        assert (found.finding, found.baud) == ("bytes", None)
        assert found.received_bytes > 0
        with pytest.raises(DeviceError, match="neither MAVLink nor text"):
            found.required_baud("/dev/ttyX")


def test_silence_is_nothing_and_takes_no_longer_than_it_must() -> None:
    clock = FakeClock()
    found = scan(RatedPort(clock, 115_200, b""), clock)
    assert (found.finding, found.received_bytes) == ("nothing", 0)
    assert clock.now_s - 100.0 == pytest.approx(START_S, abs=0.1)
    with pytest.raises(DeviceError, match="powered"):
        found.required_baud("/dev/ttyX")


def test_rate_that_the_port_does_not_have_is_passed_over() -> None:
    clock = FakeClock()
    port = RatedPort(clock, 57_600, STREAM, missing_rates=(500_000, 115_200))
    assert scan(port, clock).baud == 57_600
    assert port.tried == [57_600]
    clock = FakeClock()
    assert scan(RatedPort(clock, 1, STREAM, missing_rates=RATES), clock).finding == "nothing"


def test_port_that_goes_away_is_an_error() -> None:
    class Gone(RatedPort):
        def read(self, timeout_s: float) -> bytes | None:
            return None

    clock = FakeClock()
    with pytest.raises(DeviceError, match="went away"):
        scan(Gone(clock, 1, STREAM), clock)


def test_frames_among_noise_are_enough() -> None:
    clock = FakeClock()
    stream = NOISE[:900] + DEVICE.frames(3)[1] + NOISE[900:1800]
    assert scan(RatedPort(clock, 230_400, stream), clock).baud == 230_400


@pytest.mark.parametrize("seed", range(20))
def test_any_bytes_at_all_are_diagnosed(seed: int) -> None:
    rng = random.Random(seed)
    stream = bytes(rng.choice((0xFD, 0xFE, 0, 9, 255, rng.randrange(256))) for _ in range(500))
    clock = FakeClock()
    found = scan_baud(
        RatedPort(clock, 115_200, stream), clock=clock, rates=(115_200, 57_600), listen_s=0.1
    )
    assert found.explain()
    assert found.finding in ("bytes", "mavlink1", "mavlink2")


def test_readable_line_is_whole_and_harmless() -> None:
    assert readable_line(b"lf a line\nthis one is whole\nand ha") == "this one is whole"
    assert (
        readable_line(b"\x1b[31mred\x07 and more text than that")
        == "?[31mred? and more text than that"
    )
    assert readable_line(b"") == ""
    assert len(readable_line(b"x" * 500)) == 60
    assert text_share(b"short") == 0.0
    assert text_share(bytes(range(32, 127)) + b"\r\n\t") == 1.0
