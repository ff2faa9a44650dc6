import pytest

from hostkit.dialect import python_module
from hostkit.errors import RenderError
from hostkit.records import Axis
from hostkit.render.mavlink_context import MessageContext, mavlink_context
from hostkit.render.options import IDENTITIES


@pytest.mark.parametrize(
    ("axes", "payload_bytes", "words"),
    [((), 43, (0, 0)), (("pitch",), 47, (0, 0)), (("roll", "pitch"), 51, (0, 1))],
)
def test_hidden_words_follow_the_axes(
    axes: tuple[Axis, ...], payload_bytes: int, words: tuple[int, int]
) -> None:
    context = mavlink_context(IDENTITIES["gcs"], 1, axes)
    assert context.sample.payload_bytes == payload_bytes
    assert (context.hides_bias_roll, context.hides_bias_pitch) == ("roll" in axes, "pitch" in axes)
    assert (context.bias_roll_word, context.bias_pitch_word) == words


def test_fields_stand_where_the_dialect_packs_them() -> None:
    module = python_module()
    context = mavlink_context(IDENTITIES["component"], 7, ())
    offset = {field.name: field.offset for field in context.heartbeat.fields}
    message = module.MAVLink_heartbeat_message(
        type=1, autopilot=2, base_mode=3, custom_mode=4, system_status=5, mavlink_version=6
    )
    payload = message.pack(module.MAVLink(None))[10:-2]
    names = ("type", "autopilot", "base_mode", "custom_mode", "system_status", "mavlink_version")
    assert [payload[offset[name]] for name in names] == [1, 2, 3, 4, 5, 6]
    assert context.sample.id_bytes == tuple(module.MAVLINK_MSG_ID_TILT_SAMPLE.to_bytes(3, "little"))


def test_a_payload_that_cannot_be_numbered_is_refused() -> None:
    with pytest.raises(RenderError, match="52 bytes; the limit of hk_mavlink_tx is 51"):
        MessageContext(
            title="LONG",
            name="long",
            id_bytes=(1, 2, 3),
            crc_extra=4,
            payload_bytes=52,
            fields=(),
        )


def test_a_state_is_laid_out_for_the_words_that_are_told() -> None:
    context = mavlink_context(IDENTITIES["gcs"], 1, (), state_words=17)
    assert context.tells_state
    assert (context.state_words, context.state.payload_bytes) == (17, 4 + 4 * 17)
    assert [field.offset for field in context.state.fields] == [0, 4]
    assert context.sample.payload_bytes == 43
    assert not mavlink_context(IDENTITIES["gcs"], 1, ()).tells_state
