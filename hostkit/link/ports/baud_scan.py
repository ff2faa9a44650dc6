"""Finding the bit rate of a device, or saying what comes instead of MAVLink."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Literal, Protocol

from hostkit.dialect import python_module
from hostkit.errors import DeviceError
from hostkit.link.clock import Clock
from hostkit.link.frames.decoder import Decoder, Frame, digest_of

RATES = (500000, 115200, 57600, 921600, 460800, 230400, 1000000, 250000, 38400, 19200, 9600)
"""Usual bit rates; first that of hostkit's firmware, then in the order of their use."""
LISTEN_S = 0.6
START_S = 2.5
"""How long to wait for the first byte: an Arduino that opening has reset is in its boot loader."""
POLL_S = 0.05
KEPT_BYTES = 4096
TEXT_SHARE = 0.9
"""Share of printable bytes from which on what comes is text."""
TEXT_BYTES = 20
LINE_CHARACTERS = 60
MAGIC_V1, MAGIC_V2 = 0xFE, 0xFD

Finding = Literal["mavlink2", "mavlink1", "text", "bytes", "nothing"]


class TunablePort(Protocol):
    """A port whose bit rate can be changed while it is open, so that a board is reset once."""

    def read(self, timeout_s: float) -> bytes | None:
        """Return what came within `timeout_s`, None if the port is gone."""

    def set_baud(self, baud: int) -> bool:
        """Change the rate; tell whether the port can do it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BaudScan:
    """What came out of a port.

    Attributes
    ----------
    baud
        The rate, bit/s, at which it came; None where no rate made sense of it.
    received_bytes
        At all rates together.
    sample
        The most readable line of what is text.
    system, component
        Ids of who sent the first intact MAVLink 2 frame.
    digest
        Of the design that the device runs, if it is hostkit's and said so.
    """

    finding: Finding
    baud: int | None = None
    received_bytes: int = 0
    sample: str = ""
    system: int | None = None
    component: int | None = None
    digest: str | None = None

    def explain(self) -> str:
        """Say what was found, in one clause."""
        if self.finding == "mavlink2":
            runs = f", design {self.digest}" if self.digest else ""
            return f"MAVLink 2 at {self.baud} bit/s, system {self.system}{runs}"
        if self.finding == "mavlink1":
            return f"MAVLink 1 at {self.baud} bit/s; hostkit wants MAVLink 2"
        if self.finding == "text":
            return f"text at {self.baud} bit/s, such as {self.sample!r}; is it another program?"
        if self.finding == "bytes":
            return (
                f"{self.received_bytes} bytes that are neither MAVLink nor text at any of "
                f"{len(RATES)} rates; the device may have another rate, or the wiring is bad"
            )
        return "nothing at all; is the device powered, and does its firmware send?"

    def required_baud(self, port: str) -> int:
        """Return the rate of a device that speaks MAVLink 2.

        Raises
        ------
        DeviceError
            If none does, saying what comes instead.
        """
        if self.finding != "mavlink2" or self.baud is None:
            raise DeviceError(f"port {port} gives {self.explain()}")
        return self.baud


@dataclass(frozen=True, slots=True, kw_only=True)
class _Heard:
    """What came at one rate: all that was counted, and the beginning of it."""

    baud: int
    received_bytes: int
    beginning: bytes
    frames: tuple[Frame, ...]


def scan_baud(
    port: TunablePort,
    *,
    clock: Clock,
    rates: Iterable[int] = RATES,
    listen_s: float = LISTEN_S,
    start_s: float = START_S,
) -> BaudScan:
    """Try one rate after the other until an intact MAVLink 2 frame comes.

    Parameters
    ----------
    port
        An open port; it is left at the rate that was found.
    listen_s
        How long to listen at each rate.
    start_s
        How long to wait for the first byte; a port that is silent so long is not scanned.

    Raises
    ------
    DeviceError
        If the port goes away.
    """
    heard: list[_Heard] = []
    for baud in rates:
        if not port.set_baud(baud):
            continue
        wait_s = 0.0 if any(h.received_bytes for h in heard) else start_s
        heard.append(_listen(port, baud, clock, listen_s, wait_s))
        if heard[-1].frames:
            return _found(heard)
        if not any(h.received_bytes for h in heard):
            return BaudScan(finding="nothing")
    return _diagnose(heard)


def _listen(port: TunablePort, baud: int, clock: Clock, listen_s: float, wait_s: float) -> _Heard:
    """Listen for `listen_s`; before the first byte wait for it no less than `wait_s`."""
    decoder, kept, count = Decoder(), bytearray(), 0
    frames: tuple[Frame, ...] = ()
    end_s = clock.monotonic() + max(listen_s, wait_s)
    while (now_s := clock.monotonic()) < end_s and not _complete(frames):
        data = port.read(min(POLL_S, end_s - now_s))
        if data is None:
            raise DeviceError("the port went away while its bit rate was looked for")
        if data and not count:
            end_s = clock.monotonic() + listen_s
        count += len(data)
        kept += data[: KEPT_BYTES - len(kept)]
        frames += tuple(f for f in decoder.feed(data) if f.raw[:1] == bytes([MAGIC_V2]))[:50]
    return _Heard(baud=baud, received_bytes=count, beginning=bytes(kept), frames=frames)


def _complete(frames: tuple[Frame, ...]) -> bool:
    """Tell whether the digest is known: listening on would tell nothing more."""
    return len(frames) >= 100 or any(frame.name == "TILT_SAMPLE" for frame in frames)


def _found(heard: list[_Heard]) -> BaudScan:
    last = heard[-1]
    samples = [frame for frame in last.frames if frame.name == "TILT_SAMPLE"]
    system, component = (samples or last.frames)[0].source
    return BaudScan(
        finding="mavlink2",
        baud=last.baud,
        received_bytes=sum(h.received_bytes for h in heard),
        system=system,
        component=component,
        digest=digest_of(samples[0]) if samples else None,
    )


def _diagnose(heard: list[_Heard]) -> BaudScan:
    total = sum(h.received_bytes for h in heard)
    for each in heard:
        if any(_frames_v1(each.beginning)):
            return BaudScan(finding="mavlink1", baud=each.baud, received_bytes=total)
    best = max(heard, key=lambda h: text_share(h.beginning), default=None)
    if best is not None and text_share(best.beginning) >= TEXT_SHARE:
        sample = readable_line(best.beginning)
        return BaudScan(finding="text", baud=best.baud, received_bytes=total, sample=sample)
    return BaudScan(finding="bytes" if total else "nothing", received_bytes=total)


def text_share(data: bytes) -> float:
    """Return the share of printable ASCII; 0 where there is too little to tell."""
    if len(data) < TEXT_BYTES:
        return 0.0
    return sum(32 <= byte < 127 or byte in b"\r\n\t" for byte in data) / len(data)


def readable_line(data: bytes) -> str:
    """Return the most readable line, cut to 60 characters; the ends may be half lines."""
    lines = data.replace(b"\r", b"\n").split(b"\n")
    whole = [line for line in lines[1:-1] if line.strip()] or lines
    best = max(whole, key=lambda line: (text_share(line.ljust(TEXT_BYTES)), len(line)))
    text = best.decode("ascii", errors="replace").strip()
    return "".join(c if c.isprintable() else "?" for c in text)[:LINE_CHARACTERS]


def _frames_v1(data: bytes) -> Iterator[int]:
    """Yield where a MAVLink 1 frame with a right checksum begins."""
    module = python_module()
    begin = data.find(MAGIC_V1)
    while begin >= 0:
        frame = data[begin : begin + 8 + (data[begin + 1] if begin + 1 < len(data) else 0)]
        known = module.mavlink_map.get(frame[5]) if len(frame) >= 8 else None
        if known is not None and len(frame) == 8 + frame[1]:
            crc = module.x25crc(frame[1:-2])
            crc.accumulate(bytes([known.crc_extra]))
            if crc.crc == int.from_bytes(frame[-2:], "little"):
                yield begin
        begin = data.find(MAGIC_V1, begin + 1)
