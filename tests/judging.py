"""Feeding a validator as a session does."""

from designs import design

from hostkit.link.frames.decoder import Decoder, trace_of
from hostkit.records import AXES
from hostkit.validation import Judged, Validator


def judge(frames: list[bytes], d=None, *, batch: int = 37, **options) -> Validator:
    """Feed a validator as a session does: samples before a PARAM_VALUE are judged first."""
    d = d or design()
    validator, decoder = Validator(d, **options), Decoder()
    feed(validator, decoder, frames, d, batch)
    return validator


def feed(validator, decoder, frames, d, batch: int = 37) -> list[Judged]:
    judged = []

    def flush(samples: list) -> None:
        hidden_words = len(validator.spec.hidden)
        judged.append(validator.add(trace_of(samples, AXES[d.axes], hidden_words=hidden_words)))
        samples.clear()

    for i in range(0, len(frames), batch):
        samples: list = []
        for frame in decoder.feed(b"".join(frames[i : i + batch])):
            if frame.name == "PARAM_VALUE":
                flush(samples)
                validator.told(frame.message.param_id, frame.message.param_value)
            else:
                samples.append(frame)
        flush(samples)
    return judged
