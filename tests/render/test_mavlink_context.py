import pytest

from hostkit.dialect import python_module
from hostkit.errors import RenderError
from hostkit.render.mavlink_context import MessageContext, mavlink_context
from hostkit.render.options import IDENTITIES


@pytest.mark.parametrize(("words", "payload_bytes"), [(0, 43), (1, 47), (2, 51)])
def test_a_sample_has_room_for_hidden_words(words: int, payload_bytes: int) -> None:
    context = mavlink_context(IDENTITIES["gcs"], 1, hidden_words=words)
    assert [message.title for message in context.messages] == ["TILT_SAMPLE", "HEARTBEAT"]
    assert context.messages[0].payload_bytes == payload_bytes
    assert context.place_bits == 6


@pytest.mark.parametrize(("words", "payload_bytes"), [(3, 16), (17, 72), (24, 100)])
def test_a_long_state_has_a_message_of_its_own(words: int, payload_bytes: int) -> None:
    context = mavlink_context(IDENTITIES["gcs"], 1, hidden_words=0, state_words=words)
    sample, _, state = context.messages
    assert (sample.payload_bytes, state.title) == (43, "TILT_STATE")
    assert (state.payload_bytes, context.place_bits) == (payload_bytes, 7)
    assert [(field.name, field.offset) for field in state.fields] == [("sequence", 0), ("words", 4)]


def test_fields_stand_where_the_dialect_packs_them() -> None:
    module = python_module()
    context = mavlink_context(IDENTITIES["component"], 7, hidden_words=0)
    sample, heartbeat = context.messages
    offset = {field.name: field.offset for field in heartbeat.fields}
    message = module.MAVLink_heartbeat_message(
        type=1, autopilot=2, base_mode=3, custom_mode=4, system_status=5, mavlink_version=6
    )
    payload = message.pack(module.MAVLink(None))[10:-2]
    names = ("type", "autopilot", "base_mode", "custom_mode", "system_status", "mavlink_version")
    assert [payload[offset[name]] for name in names] == [1, 2, 3, 4, 5, 6]
    assert sample.id_bytes == tuple(module.MAVLINK_MSG_ID_TILT_SAMPLE.to_bytes(3, "little"))


def test_a_payload_that_cannot_be_numbered_is_refused() -> None:
    with pytest.raises(RenderError, match="116 bytes; the limit of hk_mavlink_tx is 115"):
        MessageContext(
            title="LONG",
            name="long",
            id_bytes=(1, 2, 3),
            crc_extra=4,
            payload_bytes=116,
            fields=(),
        )
