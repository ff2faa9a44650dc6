"""From bytes to MAVLink messages, with an account of what was lost on the way."""

import logging
from functools import lru_cache
from typing import Any

from hostkit.dialect import python_module
from hostkit.link.frames.framing import COMPONENT_AT, SEQUENCE_AT, SYSTEM_AT, Found, Framer
from hostkit.link.frames.samples import digest_of, is_retuned, trace_of
from hostkit.link.frames.sequence import SequenceAccount, Source
from hostkit.link.frames.signing import SignatureCheck, SigningKey
from hostkit.link.statistics import LinkStatistics

__all__ = ["Decoder", "Frame", "Source", "digest_of", "is_retuned", "trace_of"]

logging.getLogger("pymavlink").setLevel(logging.CRITICAL)


@lru_cache(maxsize=1)
def _unpacker() -> Any:
    return python_module().MAVLink(None)


class Frame:
    """One message that arrived whole: its sender, its content, its bytes.

    Attributes
    ----------
    raw
        The whole frame, from its first byte to its checksum or signature.
    sequence
        Its number, 0 to 255.
    repeated
        Whether it is a copy of one that came before.
    received_ns
        When its last bytes came, ns of a clock of the host that only rises; 0 if nobody said.
    recorded_us
        When it came as it was recorded, us since 1970; 0 for one that comes now.
    """

    __slots__ = (
        "_message",
        "name",
        "raw",
        "received_ns",
        "recorded_us",
        "repeated",
        "sequence",
        "source",
    )

    def __init__(
        self,
        source: Source,
        name: str,
        message: Any,
        raw: bytes,
        sequence: int,
        repeated: bool = False,
        received_ns: int = 0,
        recorded_us: int = 0,
    ) -> None:
        self.received_ns = received_ns
        self.recorded_us = recorded_us
        self.source = source
        self.name = name
        self._message = message
        self.raw = raw
        self.sequence = sequence
        self.repeated = repeated

    @property
    def message(self) -> Any:
        """The content, unpacked by pymavlink when it is first asked for.

        It is what the sender says: numbers may be NaN or infinite, counts out of any range, and
        texts hold any characters.
        """
        if self._message is None:
            self._message = _unpacker().decode(bytearray(self.raw))
        return self._message

    def time_us(self, epoch_us: int) -> int:
        """Return when it came, us since 1970; its clock was 0 at `epoch_us`, us since 1970.

        One that was recorded came when it was recorded.
        """
        return self.recorded_us or epoch_us + self.received_ns // 1000

    def __repr__(self) -> str:
        return f"Frame({self.name} {self.sequence} of {self.source}, {len(self.raw)} bytes)"


class Decoder:
    """A MAVLink 2 decoder that counts.

    Parameters
    ----------
    signing
        With a key, frames without a right and fresh signature are refused and counted; their
        numbers are not used. A signed frame that comes again or late is not fresh: it counts as
        refused, and the late one stays lost. Without a key, signed frames are taken like others.
    """

    __slots__ = ("_framer", "_sequences", "_signatures", "bad_signatures")

    def __init__(self, signing: SigningKey | None = None) -> None:
        self.bad_signatures = 0
        self._framer = Framer()
        self._sequences = SequenceAccount()
        self._signatures = None if signing is None else SignatureCheck(signing)

    def feed(self, data: bytes, received_ns: int = 0, recorded_us: int = 0) -> list[Frame]:
        """Return the messages that `data` completes; it may be any bytes at all.

        Copies of a frame are returned too, and say so.

        Parameters
        ----------
        received_ns, recorded_us
            When the bytes came, and when they did as they were recorded; every frame gets both.
        """
        found = self._framer.feed(data)
        if self._signatures is not None:
            found = self._trusted(found, self._signatures)
        take = self._sequences.take
        frames = []
        for name, raw in found:
            source, sequence = (raw[SYSTEM_AT], raw[COMPONENT_AT]), raw[SEQUENCE_AT]
            repeated = take(source, sequence, raw)
            when = (received_ns, recorded_us)
            frames.append(Frame(source, name, None, raw, sequence, repeated, *when))
        return frames

    def begin_epoch(self) -> None:
        """Begin anew after the port was opened anew: what was half received is bad bytes."""
        self._framer.drop()
        self._sequences.forget()

    def _trusted(self, found: list[Found], check: SignatureCheck) -> list[Found]:
        trusted = [(name, raw) for name, raw in found if check.accepts(raw)]
        self.bad_signatures += len(found) - len(trusted)
        return trusted

    @property
    def frames(self) -> int:
        """Frames that arrived whole, each once."""
        return self.statistics().frames

    @property
    def lost_frames(self) -> int:
        """Frames that never arrived."""
        return self.statistics().lost_frames

    @property
    def bad(self) -> int:
        """Pieces of the stream that were no frame."""
        return self._framer.bad

    @property
    def bad_bytes(self) -> int:
        """The bytes of those pieces."""
        return self._framer.bad_bytes

    @property
    def unknown(self) -> int:
        """Frames of an id that the dialect does not have."""
        return self._framer.unknown

    @property
    def pending_bytes(self) -> int:
        """Bytes that are not decided on yet; less than the longest frame."""
        return self._framer.pending_bytes

    def statistics(self) -> LinkStatistics:
        """Return the account so far."""
        framer, sources = self._framer, self._sequences.statistics()
        return LinkStatistics(
            received_bytes=framer.received_bytes,
            frames=sum(source.frames for source in sources),
            lost_frames=sum(source.lost for source in sources),
            duplicated=sum(source.duplicated for source in sources),
            reordered=sum(source.reordered for source in sources),
            bad=framer.bad,
            bad_bytes=framer.bad_bytes,
            crc_failures=framer.crc_failures,
            bad_signatures=self.bad_signatures,
            unknown=framer.unknown,
            resyncs=framer.resyncs,
            sources=sources,
        )
