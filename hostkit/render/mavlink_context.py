"""What templates see of the MAVLink messages that an FPGA sends: layouts, ids and numbers."""

import struct
from dataclasses import dataclass
from typing import Any

from hostkit.dialect import python_module, sample_bytes, state_bytes
from hostkit.errors import RenderError
from hostkit.render.options import Identity

OTHER_PLACES = 13
"""Bytes of a frame that `hk_mavlink_tx` numbers beside its payload."""
PLACE_BITS, PLACE_BITS_WITH_STATE = 6, 7
"""Bits of such a number."""
MOST_PAYLOAD_BYTES = 2**PLACE_BITS_WITH_STATE - OTHER_PLACES
MAVLINK_VERSION = 3
"""The protocol's own number, in every HEARTBEAT of version 2."""
FLAGS = ("RESTARTED", "SATURATED", "RETUNED")


@dataclass(frozen=True, slots=True, kw_only=True)
class FieldContext:
    """A field of a payload: its name and the place of its first byte."""

    name: str
    offset: int


@dataclass(frozen=True, slots=True, kw_only=True)
class MessageContext:
    """A message as it is sent.

    Attributes
    ----------
    title
        Its name in the dialect.
    name
        Prefix of its constants.
    id_bytes
        The identity, lowest byte first.
    crc_extra
        What the checksum takes up after the payload.
    payload_bytes
        As many as can be other than zero.
    fields
        In the order of the wire.
    """

    title: str
    name: str
    id_bytes: tuple[int, int, int]
    crc_extra: int
    payload_bytes: int
    fields: tuple[FieldContext, ...]

    def __post_init__(self) -> None:
        """Refuse what the core cannot number."""
        if self.payload_bytes > MOST_PAYLOAD_BYTES:
            raise RenderError(
                f"{self.title} has a payload of {self.payload_bytes} bytes; "
                f"the limit of hk_mavlink_tx is {MOST_PAYLOAD_BYTES}"
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class FlagContext:
    """A flag of ``TILT_SAMPLE``: its name and its bit."""

    name: str
    bit: int


@dataclass(frozen=True, slots=True, kw_only=True)
class MavlinkContext:
    """The messages and who sends them.

    Attributes
    ----------
    magic, mavlink_version
        First byte of a frame; the protocol's number in a heartbeat.
    system_id, component_id, vehicle_type, autopilot
        Who the device says it is.
    messages
        Those that are sent.
    place_bits
        Bits of the number of a byte.
    flags
        Of a sample.
    """

    magic: int
    mavlink_version: int
    system_id: int
    component_id: int
    vehicle_type: int
    autopilot: int
    messages: tuple[MessageContext, ...]
    place_bits: int
    flags: tuple[FlagContext, ...]


def mavlink_context(
    identity: Identity, system_id: int, *, hidden_words: int, state_words: int = 0
) -> MavlinkContext:
    """Lay out the messages of the dialect that the installed pymavlink makes.

    Parameters
    ----------
    hidden_words
        Words of the filter's state that ``TILT_SAMPLE`` tells.
    state_words
        Those that ``TILT_STATE`` tells; 0 where it is not sent.

    Raises
    ------
    RenderError
        If mavgen makes nothing, or a payload is longer than the core can send.
    """
    module: Any = python_module()
    messages = [
        _message("TILT_SAMPLE", "sample", sample_bytes(hidden_words)),
        _message("HEARTBEAT", "heartbeat", None),
    ]
    if state_words:
        messages.append(_message("TILT_STATE", "state", state_bytes(state_words)))
    return MavlinkContext(
        magic=module.PROTOCOL_MARKER_V2,
        mavlink_version=MAVLINK_VERSION,
        system_id=system_id,
        component_id=identity.component_id,
        vehicle_type=identity.vehicle_type,
        autopilot=identity.autopilot,
        messages=tuple(messages),
        place_bits=PLACE_BITS_WITH_STATE if state_words else PLACE_BITS,
        flags=tuple(_flag(module, name) for name in FLAGS),
    )


def _flag(module: Any, name: str) -> FlagContext:
    weight = int(getattr(module, f"HOSTKIT_SAMPLE_{name}"))
    return FlagContext(name=name.lower(), bit=weight.bit_length() - 1)


def _message(name: str, prefix: str, used_bytes: int | None) -> MessageContext:
    module: Any = python_module()
    number = int(getattr(module, f"MAVLINK_MSG_ID_{name}"))
    kind = module.mavlink_map[number]
    first, second, third = number.to_bytes(3, "little")
    return MessageContext(
        title=name,
        name=prefix,
        id_bytes=(first, second, third),
        crc_extra=int(kind.crc_extra),
        payload_bytes=kind.unpacker.size if used_bytes is None else used_bytes,
        fields=_fields(kind),
    )


def _fields(kind: Any) -> tuple[FieldContext, ...]:
    """Return the fields of a message; `lengths` and `array_lengths` follow the wire."""
    # struct pads nothing here: the format begins with "<".
    types = kind.unpacker.format.lstrip("<")
    fields = []
    offset = 0
    for name, one in zip(kind.ordered_fieldnames, _parts(types), strict=True):
        fields.append(FieldContext(name=name, offset=offset))
        offset += struct.calcsize(f"<{one}")
    return tuple(fields)


def _parts(types: str) -> list[str]:
    """Split a format of struct into its items, each with its count."""
    parts: list[str] = []
    count = ""
    for letter in types:
        if letter.isdigit():
            count += letter
        else:
            parts.append(count + letter)
            count = ""
    return parts
