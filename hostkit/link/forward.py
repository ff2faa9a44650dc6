"""Passing frames on to another program, and its frames to the device."""

from dataclasses import dataclass

from hostkit.link.clock import SystemClock
from hostkit.link.device.exchange import MonotonicClock
from hostkit.link.frames.decoder import Decoder
from hostkit.link.ports.addresses import open_udp, resolve_udp

DATAGRAMS_PER_POLL = 64
LARGEST_DATAGRAM_BYTES = 4096
BYTES_PER_S = 4000.0
BURST_BYTES = 4000.0
"""What a peer may send to the device: a third of what a line at 115200 Bd carries."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ForwardCounts:
    """What went to a peer and what came back.

    Attributes
    ----------
    sent_frames, dropped_frames
        Frames to the peer that went out, or did not because the system took no more.
    received_frames
        Frames of the peer that were passed to the device.
    refused_frames
        Frames of the peer that were not: more than BYTES_PER_S.
    refused_bytes
        Bytes of the peer that were no frame of a message that the device knows.
    """

    address: str
    sent_frames: int
    dropped_frames: int
    received_frames: int
    refused_frames: int
    refused_bytes: int


class Forwarder:
    """A UDP socket to one peer, such as a ground station; it never waits.

    The socket is connected, so the system drops what others send to it. What the peer sends
    is taken apart first, and only whole frames of known messages are passed to the device.

    Parameters
    ----------
    address
        ``udp:HOST:PORT``, where the peer listens.

    Raises
    ------
    DeviceError
        If the address is none, or cannot be reached.
    """

    def __init__(self, address: str, *, clock: MonotonicClock | None = None) -> None:
        self._socket = open_udp(resolve_udp(address))
        self._address = address
        self._clock = SystemClock() if clock is None else clock
        self._decoder = Decoder()
        self._sent = self._dropped = self._received = self._refused = 0
        self._refused_bytes = 0
        self._allowed_bytes = BURST_BYTES
        self._allowed_s = self._clock.monotonic()

    def send(self, raw: bytes) -> None:
        """Send one frame to the peer, or drop it."""
        try:
            self._socket.send(raw)
        except ConnectionRefusedError:
            # The refusal is of an earlier datagram: nobody listens there yet. This one may go.
            self._try_again(raw)
        except OSError:
            self._dropped += 1
        else:
            self._sent += 1

    def receive(self) -> list[bytes]:
        """Return the frames that came from the peer, to be written to the device."""
        self._refill()
        frames = []
        for _ in range(DATAGRAMS_PER_POLL):
            try:
                datagram = self._socket.recv(LARGEST_DATAGRAM_BYTES)
            except OSError:
                break  # nothing more, or a refusal of what was sent before
            frames += self._frames_of(datagram)
        return frames

    def state(self) -> ForwardCounts:
        """Return the account so far."""
        return ForwardCounts(
            address=self._address,
            sent_frames=self._sent,
            dropped_frames=self._dropped,
            received_frames=self._received,
            refused_frames=self._refused,
            refused_bytes=self._refused_bytes,
        )

    def close(self) -> None:
        """Close the socket."""
        self._socket.close()

    def _try_again(self, raw: bytes) -> None:
        try:
            self._socket.send(raw)
            self._sent += 1
        except OSError:
            self._dropped += 1

    def _frames_of(self, datagram: bytes) -> list[bytes]:
        """Return the frames of a datagram that the device may have."""
        found = [frame.raw for frame in self._decoder.feed(datagram)]
        self._decoder.begin_epoch()  # a frame does not go on in the next datagram
        self._refused_bytes += len(datagram) - sum(map(len, found))
        passed = []
        for raw in found:
            if len(raw) > self._allowed_bytes:
                self._refused += 1
                continue
            self._allowed_bytes -= len(raw)
            self._received += 1
            passed.append(raw)
        return passed

    def _refill(self) -> None:
        now_s = self._clock.monotonic()
        more = (now_s - self._allowed_s) * BYTES_PER_S
        self._allowed_bytes = min(BURST_BYTES, self._allowed_bytes + more)
        self._allowed_s = now_s
