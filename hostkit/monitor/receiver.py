"""Everything that comes from a port: bytes, frames, and what became of the port meanwhile."""

from dataclasses import dataclass, replace

from hostkit.link.clock import Clock, now_ns
from hostkit.link.frames.decoder import Decoder, Frame
from hostkit.link.frames.signing import SigningKey
from hostkit.link.logs.replay import ReplayTransport
from hostkit.link.ports.pump import Pump
from hostkit.link.ports.transport import Transport
from hostkit.link.statistics import LinkStatistics
from hostkit.monitor.notices import Notices

HEARD_BYTES = 512
"""What is kept of bytes that hold no frame, to say what they are."""

TEXT_SHARE = 0.9
"""Share of printable bytes from which on noise is taken for text."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Received:
    """What one look at the port brought.

    Attributes
    ----------
    ended
        Whether nothing can come any more: a file's end, or a device gone for good.
    opened_anew
        Whether counters and device time from before are void.
    """

    frames: list[Frame]
    ended: bool = False
    opened_anew: bool = False
    lost_some: bool = False


def decoder_for(transport: Transport, signing: SigningKey | None) -> Decoder:
    """Return a decoder for a transport; the signatures in a file may be of any time."""
    if signing is not None and not transport.live:
        signing = signing.for_replay()
    return Decoder(signing)


class Receiver:
    """A transport with its decoder; says in notices what becomes of the port.

    Attributes
    ----------
    reconnects
        How often a lost port came back.
    heard
        The latest bytes that came before the first frame.
    """

    def __init__(
        self, transport: Transport, decoder: Decoder, clock: Clock, notices: Notices
    ) -> None:
        self._transport, self.decoder = transport, decoder
        self._clock, self._notices = clock, notices
        self._epoch, self._state = transport.epoch, transport.state
        self._left_s = 0.0
        self._overrun_bytes = self._lost_frames = 0
        self._understood = False
        self.reconnects = 0
        self.heard = b""

    def receive(self, timeout_s: float) -> Received:
        """Look at the port once."""
        data = self._transport.read(timeout_s)
        opened_anew = self._follow_port()
        if data is None:
            return Received(frames=[], ended=True, opened_anew=opened_anew)
        if opened_anew:
            self.decoder.begin_epoch()
        if not self._understood:
            self.heard = (self.heard + data)[-HEARD_BYTES:]
        frames = self._decode(data)
        self._understood = self._understood or bool(frames)
        before, self._lost_frames = self._lost_frames, self.decoder.lost_frames
        lost_some = self._lost_frames != before
        return Received(frames=frames, opened_anew=opened_anew, lost_some=lost_some)

    def _decode(self, data: bytes) -> list[Frame]:
        """Decode bytes piece by piece, where it is known when the pieces came."""
        frames: list[Frame] = []
        begin = 0
        for end, received_ns, recorded_us in self._pieces(data):
            frames += self.decoder.feed(data[begin:end], received_ns, recorded_us)
            begin = end
        return frames

    def _pieces(self, data: bytes) -> list[tuple[int, int, int]]:
        """Return of each piece where it ends, when it came, and when it did when recorded."""
        transport = self._transport
        if isinstance(transport, Pump) and transport.arrivals:
            return [(arrival.end, arrival.received_ns, 0) for arrival in transport.arrivals]
        now = now_ns(self._clock)
        if isinstance(transport, ReplayTransport) and transport.stamps:
            return [(end, now, time_us) for end, time_us in transport.stamps]
        return [(len(data), now, 0)]

    def _follow_port(self) -> bool:
        """Compare the port with what it was; tell whether it was opened anew."""
        state, epoch = self._transport.state, self._transport.epoch
        if state != self._state:
            self._tell_state(self._state, state)
            self._state = state
        overrun_bytes = self._transport.overrun_bytes
        if overrun_bytes > self._overrun_bytes:
            self._overrun_bytes = overrun_bytes
            self._notices.add("warning", f"{overrun_bytes} bytes were dropped: hostkit is too slow")
        if epoch == self._epoch:
            return False
        self._epoch = epoch
        if self._transport.live:
            self.reconnects += 1
        return True

    def _tell_state(self, before: str, state: str) -> None:
        now = self._clock.monotonic()
        if before == "connected":
            self._left_s = now
        if state == "lost":
            self._notices.add("error", "port lost")
        elif state == "released":
            self._notices.add("info", "port released")
        elif state == "connected" and self._transport.live:
            self._notices.add("info", f"port is back after {now - self._left_s:.1f} s")

    def statistics(self) -> LinkStatistics:
        """Return the account of the link."""
        overrun_bytes = self._transport.overrun_bytes
        return replace(self.decoder.statistics(), overrun_bytes=overrun_bytes)

    def explain_noise(self, waited_s: float) -> str:
        """Say what the bytes are that held no frame."""
        if not self.heard:
            return f"nothing was received in {waited_s:g} s; is the device powered and wired?"
        printable = sum(32 <= byte < 127 or byte in b"\r\n\t" for byte in self.heard)
        if printable >= TEXT_SHARE * len(self.heard):
            return f"the port carries text, not MAVLink: {self.heard[-60:]!r}"
        return "bytes come that are not MAVLink 2; is the --baud rate that of the device?"
