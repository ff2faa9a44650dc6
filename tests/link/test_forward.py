"""Frames to another program and back: nothing waits, nothing but frames reaches the device."""

import socket
from collections.abc import Iterator

import pytest
from answering import M, ManualClock, Sender
from hypothesis import given, settings
from hypothesis import strategies as st

from hostkit.errors import DeviceError
from hostkit.link.forward import BURST_BYTES, BYTES_PER_S, DATAGRAMS_PER_POLL, Forwarder
from hostkit.link.frames.decoder import Decoder

STATION = Sender(255, 230)


class Peer:
    """A program that listens at a UDP port of its own."""

    def __init__(self) -> None:
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.socket.settimeout(5.0)
        self.address = f"udp:127.0.0.1:{self.socket.getsockname()[1]}"
        self.forwarder: tuple[str, int] | None = None

    def hear(self) -> bytes:
        data, self.forwarder = self.socket.recvfrom(65536)
        return data

    def say(self, data: bytes) -> None:
        assert self.forwarder is not None
        self.socket.sendto(data, self.forwarder)


@pytest.fixture
def peer() -> Iterator[Peer]:
    peer = Peer()
    yield peer
    peer.socket.close()


@pytest.fixture
def joined(peer: Peer) -> Iterator[tuple[Forwarder, Peer, ManualClock]]:
    """A forwarder whose peer has heard of it."""
    clock = ManualClock()
    forwarder = Forwarder(peer.address, clock=clock)
    forwarder.send(Sender().heartbeat())
    peer.hear()
    yield forwarder, peer, clock
    forwarder.close()


def setting(value: float = 1.5) -> bytes:
    return STATION.pack(M.MAVLink_param_set_message(1, 1, b"FILT_TAU", value, 9))


def test_frames_go_out_as_they_are(peer: Peer) -> None:
    forwarder = Forwarder(peer.address)
    frames = [Sender().sample(i) for i in range(20)]
    for frame in frames:
        forwarder.send(frame)
    assert [peer.hear() for _ in frames] == frames
    counts = forwarder.state()
    assert (counts.address, counts.sent_frames, counts.dropped_frames) == (peer.address, 20, 0)
    forwarder.close()


def test_frames_of_the_peer_come_back_whole(joined) -> None:
    forwarder, peer, _ = joined
    first, second, third = setting(1.0), setting(2.0), setting(3.0)
    peer.say(first + second)
    peer.say(third)
    assert forwarder.receive() == [first, second, third]
    assert forwarder.receive() == []
    assert forwarder.state().received_frames == 3
    assert forwarder.state().refused_bytes == 0


def test_what_is_no_frame_does_not_reach_the_device(joined) -> None:
    forwarder, peer, _ = joined
    good = setting()
    spoilt = bytes([*good[:-1], good[-1] ^ 1])
    foreign = bytes.fromhex("fd090000000101ffff010000000000000000000000")
    half = good[:20]
    for data in (b"", b"\x00" * 500, spoilt, foreign, half, good, b"GET / HTTP/1.1\r\n\r\n"):
        peer.say(data)
    assert forwarder.receive() == [good]
    noise = 500 + len(spoilt) + len(foreign) + len(half) + 18
    assert forwarder.state().refused_bytes == noise


def test_a_frame_in_two_datagrams_is_none(joined) -> None:
    forwarder, peer, _ = joined
    frame = setting()
    peer.say(frame[:20])
    peer.say(frame[20:])
    assert forwarder.receive() == []
    assert forwarder.state().refused_bytes == len(frame)


def test_others_are_not_heard(joined) -> None:
    forwarder, peer, _ = joined
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:
        stranger.sendto(setting(9.0), peer.forwarder)
    ours = setting()
    peer.say(ours)
    assert forwarder.receive() == [ours]


def test_a_peer_cannot_jam_the_device(joined) -> None:
    forwarder, peer, clock = joined
    frame = setting()
    for _ in range(60):
        peer.say(frame * 10)
    passed = forwarder.receive()
    assert sum(map(len, passed)) <= BURST_BYTES
    assert len(passed) == BURST_BYTES // len(frame)
    assert forwarder.state().refused_frames == 600 - len(passed)
    clock.now_s += 0.5
    for _ in range(60):
        peer.say(frame * 10)
    again = forwarder.receive()
    assert 0.9 * BYTES_PER_S / 2 < sum(map(len, again)) <= BYTES_PER_S / 2 + len(frame)


def test_one_poll_takes_a_bounded_number_of_datagrams(joined) -> None:
    forwarder, peer, _ = joined
    for _ in range(DATAGRAMS_PER_POLL + 16):
        peer.say(b"noise")
    forwarder.receive()
    assert forwarder.state().refused_bytes == 5 * DATAGRAMS_PER_POLL
    forwarder.receive()
    assert forwarder.state().refused_bytes == 5 * (DATAGRAMS_PER_POLL + 16)


def test_nobody_listening_is_no_error_and_the_peer_may_come_later(peer: Peer) -> None:
    forwarder = Forwarder(peer.address)
    host, port = peer.socket.getsockname()
    peer.socket.close()
    for i in range(20):
        forwarder.send(Sender().sample(i))
        assert forwarder.receive() == []
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as late:
        late.bind((host, port))
        late.settimeout(5.0)
        frame = Sender().sample(99)
        forwarder.send(frame)
        assert late.recv(4096) == frame
    counts = forwarder.state()
    assert counts.sent_frames + counts.dropped_frames == 21
    forwarder.close()


def test_what_the_system_does_not_take_is_counted_as_dropped(peer: Peer) -> None:
    forwarder = Forwarder(peer.address)
    forwarder.send(b"x" * 70000)
    assert forwarder.state().dropped_frames == 1
    forwarder.close()


@pytest.mark.parametrize(
    "address",
    ["udp:127.0.0.1", "udp::1", "tcp:h:1", "udp:h:0", "udp:h:65536", "udp:h:x", "h:1", "udp:h:²"],
)
def test_what_is_no_address_is_said(address: str) -> None:
    with pytest.raises(DeviceError, match="is not udp:HOST:PORT"):
        Forwarder(address)


def test_an_unknown_host_is_said() -> None:
    with pytest.raises(DeviceError, match="is not known"):
        Forwarder("udp:no-such-host.invalid:14550")


@given(st.lists(st.binary(max_size=400), max_size=8))
@settings(max_examples=50, deadline=None)
def test_whatever_the_peer_sends_only_frames_come_out(datagrams: list[bytes]) -> None:
    peer = Peer()
    forwarder = Forwarder(peer.address, clock=ManualClock())
    forwarder.send(b"\x00")
    peer.hear()
    good = setting()
    for data in (*datagrams, good):
        peer.say(data)
    passed = forwarder.receive()
    peer.socket.close()
    forwarder.close()
    assert passed[-1] == good
    for raw in passed:
        assert [frame.raw for frame in Decoder().feed(raw)] == [raw]
