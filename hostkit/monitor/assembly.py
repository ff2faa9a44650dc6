"""Putting the parts of a session together."""

from collections.abc import Sequence
from functools import partial

from hostkit.link.clock import Clock, now_ns
from hostkit.link.frames.encoder import Encoder
from hostkit.link.frames.timesync import TimeSync
from hostkit.link.ports.transport import Transport
from hostkit.monitor.conversation import Conversation
from hostkit.monitor.judge import Judge
from hostkit.monitor.notices import Notices
from hostkit.monitor.outlets import Outlets
from hostkit.monitor.parts import Parts, SessionOptions
from hostkit.monitor.receiver import Receiver, decoder_for
from hostkit.monitor.recording.recordings import Recorder, Recordings
from hostkit.monitor.recording.sample_files import open_recorder
from hostkit.records import FilterDesign
from hostkit.validation import Thresholds, Validator


def assemble(
    design: FilterDesign,
    transport: Transport,
    thresholds: Thresholds,
    options: SessionOptions,
    clock: Clock,
    *,
    recorders: Sequence[Recorder],
    outlets: Outlets,
) -> Parts:
    """Return the parts of a session; a recorded device is only listened to."""
    notices, key = Notices(clock), options.signing
    silent = options.passive or not transport.live
    validator = Validator(
        design, tolerance_rad=options.tolerance_rad, as_designed=options.as_designed
    )
    judge = Judge(
        design, validator, notices, system=options.system, as_designed=options.as_designed
    )
    return Parts(
        thresholds=thresholds,
        transport=transport,
        clock=clock,
        notices=notices,
        receiver=Receiver(transport, decoder_for(transport, key), clock, notices),
        validator=validator,
        judge=judge,
        conversation=Conversation(transport, Encoder(key), clock, notices, design, silent=silent),
        timesync=TimeSync(partial(now_ns, clock)),
        recordings=Recordings(
            recorders,
            notices,
            folder=options.folder,
            opener=partial(open_recorder, design=design, system=options.system),
        ),
        outlets=outlets,
    )
