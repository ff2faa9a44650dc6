"""What templates see of the MAVLink messages that an FPGA sends: layouts, ids and numbers."""

import struct
from dataclasses import dataclass
from typing import Any

from hostkit.dialect import STATE_WORDS, python_module, sample_bytes, state_bytes
from hostkit.errors import RenderError
from hostkit.records import Axis
from hostkit.render.options import Identity

MOST_PAYLOAD_BYTES = 51
"""`hk_mavlink_tx` numbers the bytes of a frame with 6 bits, and 13 are not of the payload."""
MOST_STATE_BYTES = 114
"""The same of ``TILT_STATE``: where it is sent, bytes are numbered with 7 bits."""
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
        most = MOST_STATE_BYTES if self.title == "TILT_STATE" else MOST_PAYLOAD_BYTES
        if self.payload_bytes > most:
            raise RenderError(
                f"{self.title} has a payload of {self.payload_bytes} bytes; "
                f"the limit of hk_mavlink_tx is {most}"
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
    sample, heartbeat, state
        The messages.
    tells_state, state_words
        Whether the last of them is sent, and how many of its words are used.
    hides_bias_roll, hides_bias_pitch
        Whether that bias is hidden state.
    bias_roll_word, bias_pitch_word
        Which word of it; 0 if it is none.
    flags
        Of a sample.
    """

    magic: int
    mavlink_version: int
    system_id: int
    component_id: int
    vehicle_type: int
    autopilot: int
    sample: MessageContext
    heartbeat: MessageContext
    state: MessageContext
    tells_state: bool
    state_words: int
    hides_bias_roll: bool
    hides_bias_pitch: bool
    bias_roll_word: int
    bias_pitch_word: int
    flags: tuple[FlagContext, ...]


def mavlink_context(
    identity: Identity, system_id: int, hidden_axes: tuple[Axis, ...], *, state_words: int = 0
) -> MavlinkContext:
    """Lay out the messages of the dialect that the installed pymavlink makes.

    Parameters
    ----------
    hidden_axes
        Axes whose bias is hidden state, in the order of the design.
    state_words
        Words that ``TILT_STATE`` tells; 0 where it is not sent.

    Raises
    ------
    RenderError
        If mavgen makes nothing, or a payload is longer than the core can send.
    """
    module: Any = python_module()
    return MavlinkContext(
        magic=module.PROTOCOL_MARKER_V2,
        mavlink_version=MAVLINK_VERSION,
        system_id=system_id,
        component_id=identity.component_id,
        vehicle_type=identity.vehicle_type,
        autopilot=identity.autopilot,
        sample=_message("TILT_SAMPLE", "sample", sample_bytes(len(hidden_axes))),
        heartbeat=_message("HEARTBEAT", "heartbeat", None),
        state=_message("TILT_STATE", "state", state_bytes(state_words or STATE_WORDS)),
        tells_state=state_words > 0,
        state_words=state_words,
        hides_bias_roll="roll" in hidden_axes,
        hides_bias_pitch="pitch" in hidden_axes,
        bias_roll_word=_word("roll", hidden_axes),
        bias_pitch_word=_word("pitch", hidden_axes),
        flags=tuple(_flag(module, name) for name in FLAGS),
    )


def _word(axis: Axis, hidden_axes: tuple[Axis, ...]) -> int:
    return hidden_axes.index(axis) if axis in hidden_axes else 0


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
