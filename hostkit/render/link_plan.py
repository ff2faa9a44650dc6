"""Which message goes out how often, and whether the link can carry it."""

import math
from dataclasses import dataclass, replace

from hostkit.dialect import (
    FRAME_OVERHEAD_BYTES,
    HIDDEN_WORDS,
    SIGNATURE_BYTES,
    STATE_WORDS,
    payload_bytes,
    sample_bytes,
    state_bytes,
)
from hostkit.errors import RenderError
from hostkit.filters import FILTERS
from hostkit.records import FilterDesign
from hostkit.render.options import (
    DEFAULT_OPTIONS,
    SAMPLE_MESSAGES,
    STREAMED_MESSAGES,
    FirmwareOptions,
)
from hostkit.targets import Target

ATTITUDE_MAX_HZ = 50.0
"""Unless more is asked for."""
STATE_HZ = 1.0
"""So often the state of a filter is told that does not fit its samples."""
DEFAULT_TIMED_HZ = {"SYS_STATUS": 1.0, "HEARTBEAT": 1.0}
DIVISOR_TOLERANCE = 1e-3
"""A rate is taken for an integer divisor of another if it is as near as it is commonly written."""
BITS_PER_BYTE = 10
"""Start bit, eight data bits, stop bit."""
USABLE_PERCENT = 80
"""The rest is left for events, answers and parameters."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StreamedMessage:
    """One message that goes out again and again.

    Attributes
    ----------
    every
        It goes out with every so many-th sample; 0 for those that go by the clock or not at all.
    interval_us
        Time between two of them, microseconds; 0 is off.
    frame_bytes
        Its bytes on the link at most.
    """

    name: str
    every: int
    interval_us: int
    frame_bytes: int

    @property
    def rate_hz(self) -> float:
        """Messages a second."""
        return 1e6 / self.interval_us if self.interval_us else 0.0

    @property
    def bytes_per_s(self) -> float:
        """What it takes of the link."""
        return self.rate_hz * self.frame_bytes


@dataclass(frozen=True, slots=True, kw_only=True)
class LinkPlan:
    """The telemetry of a firmware: identity, rate of the link, messages.

    Attributes
    ----------
    usable_bytes_s
        What the link may be asked to carry, bytes/s; 0 where there is no link.
    messages
        All that can be streamed, in the order in which they are sent. TILT_STATE is among them
        only if the filter's state does not fit TILT_SAMPLE.
    state_words
        Words that TILT_STATE tells; 0 where it is not sent.
    """

    system_id: int
    component_id: int
    vehicle_type: int
    autopilot: int
    baud: int
    usable_bytes_s: int
    messages: tuple[StreamedMessage, ...]
    state_words: int

    @property
    def bytes_per_s(self) -> int:
        """What the streamed messages take together, rounded up."""
        return math.ceil(sum(message.bytes_per_s for message in self.messages) - 1e-6)

    @property
    def running(self) -> tuple[StreamedMessage, ...]:
        """Messages that are not off."""
        return tuple(message for message in self.messages if message.interval_us)

    @property
    def summary(self) -> str:
        """The budget in one line."""
        parts = ", ".join(f"{m.name} {m.rate_hz:.6g} Hz" for m in self.running)
        return (
            f"{self.bytes_per_s} of {self.usable_bytes_s} bytes/s "
            f"({USABLE_PERCENT} % of {self.baud} baud): {parts}"
        )

    def every(self, name: str) -> int:
        """Return with which samples a message goes out: every so many-th; 0 if with none."""
        return next((m.every for m in self.messages if m.name == name), 0)


def link_plan(
    rate_hz: float,
    target: Target,
    options: FirmwareOptions = DEFAULT_OPTIONS,
    *,
    hidden_words: int = 0,
) -> LinkPlan:
    """Plan the telemetry of a design and make sure that the link carries it.

    Parameters
    ----------
    rate_hz
        Samples a second.
    hidden_words
        Words of the filter's state beside its angles. Every sample carries them, or if they are too
        many a message of their own does.

    Raises
    ------
    RenderError
        If the messages do not fit 80 % of the link, the target cannot make its rate, no message
        can carry the state, or a message is to go out at a rate that the samples do not give.
    """
    _require_words(hidden_words, options)
    identity = options.identity
    baud = options.baud or target.baud
    _require_baud(target, baud)
    plan = LinkPlan(
        system_id=options.system_id,
        component_id=identity.component_id,
        vehicle_type=identity.vehicle_type,
        autopilot=identity.autopilot,
        baud=baud,
        usable_bytes_s=baud // BITS_PER_BYTE * USABLE_PERCENT // 100,
        messages=tuple(
            _streamed(name, rate_hz, options, hidden_words)
            for name in STREAMED_MESSAGES
            if name != "TILT_STATE" or hidden_words > HIDDEN_WORDS
        ),
        state_words=hidden_words if hidden_words > HIDDEN_WORDS else 0,
    )
    if baud and plan.bytes_per_s > plan.usable_bytes_s:
        raise RenderError(_too_much(plan, rate_hz, target))
    return plan


def link_of(design: FilterDesign, target: Target, options: FirmwareOptions) -> LinkPlan:
    """Plan the telemetry of a design: see :func:`link_plan`."""
    spec = FILTERS[design.filter].lower(design)
    return link_plan(design.rate_hz, target, options, hidden_words=len(spec.hidden))


def _require_words(hidden_words: int, options: FirmwareOptions) -> None:
    if hidden_words > STATE_WORDS:
        raise RenderError(
            f"the filter has {hidden_words} words of state beside its angles; "
            f"TILT_STATE carries {STATE_WORDS}"
        )
    if options.rate_hz("TILT_STATE") and hidden_words <= HIDDEN_WORDS:
        raise RenderError(
            "this filter has no TILT_STATE: each TILT_SAMPLE tells its whole state; "
            "leave the message out"
        )


def _require_baud(target: Target, baud: int) -> None:
    if target.uart is None or target.uart.makes(baud):
        return
    raise RenderError(
        f"the {target.name} makes {target.uart.made(baud):.0f} of {baud} baud, "
        f"{100.0 * target.uart.error(baud):+.1f} %; the limit is "
        f"{100.0 * target.uart.tolerance:g} %, and the nearest good rates are "
        + ", ".join(map(str, target.uart.near(baud)))
    )


def _streamed(
    name: str, rate_hz: float, options: FirmwareOptions, hidden_words: int
) -> StreamedMessage:
    overhead = FRAME_OVERHEAD_BYTES + (SIGNATURE_BYTES if options.signing else 0)
    chosen_hz = options.rate_hz(name)
    if name in SAMPLE_MESSAGES:
        every = _every(name, rate_hz, chosen_hz)
        if name == "TILT_STATE":
            samples = _every("TILT_SAMPLE", rate_hz, options.rate_hz("TILT_SAMPLE"))
            every = _with_samples(every, samples, chosen_hz)
        interval_us = every * round(1e6 / rate_hz)
    else:
        every = 0
        hz = DEFAULT_TIMED_HZ[name] if chosen_hz is None else chosen_hz
        interval_us = round(1e6 / hz) if hz else 0
    return StreamedMessage(
        name=name,
        every=every,
        interval_us=interval_us,
        frame_bytes=_payload(name, hidden_words) + overhead,
    )


def _with_samples(every: int, samples: int, chosen_hz: float | None) -> int:
    """Return with every how-many-th sample a state goes out, which is told behind its sample."""
    if samples:
        return max(1, round(every / samples)) * samples if every else 0
    if chosen_hz:
        raise RenderError(
            f"TILT_STATE = {chosen_hz:g} Hz, but TILT_SAMPLE is off, behind which it goes out"
        )
    return 0


def _payload(name: str, hidden_words: int) -> int:
    """Return the bytes of a message's payload that may be other than zero."""
    if name == "TILT_STATE":
        return state_bytes(hidden_words)
    if name == "TILT_SAMPLE":
        return sample_bytes(0 if hidden_words > HIDDEN_WORDS else hidden_words)
    return payload_bytes(name)


def _every(name: str, rate_hz: float, chosen_hz: float | None) -> int:
    """Return with every how-many-th sample a message goes out, 0 for never."""
    if chosen_hz is None:
        default = {
            "TILT_SAMPLE": 1,
            "TILT_STATE": max(1, round(rate_hz / STATE_HZ)),
            "ATTITUDE": max(1, math.ceil(rate_hz / ATTITUDE_MAX_HZ)),
        }
        return default.get(name, 0)
    if chosen_hz == 0.0:
        return 0
    ratio = rate_hz / chosen_hz
    if ratio < 1.0 - DIVISOR_TOLERANCE:
        raise RenderError(f"{name} = {chosen_hz:g} Hz, but there are {rate_hz:g} samples a second")
    every = max(1, round(ratio))
    if name == "TILT_SAMPLE" and abs(every - ratio) > DIVISOR_TOLERANCE * ratio:
        near = sorted({rate_hz / math.ceil(ratio), rate_hz / math.floor(ratio)})
        raise RenderError(
            f"TILT_SAMPLE = {chosen_hz:g} Hz is no integer divisor of {rate_hz:g} Hz; the nearest "
            f"are {' and '.join(f'{hz:.6g}' for hz in near)} Hz"
        )
    return every if abs(every - ratio) <= DIVISOR_TOLERANCE * ratio else math.ceil(ratio)


def _too_much(plan: LinkPlan, rate_hz: float, target: Target) -> str:
    """Say what a plan takes and what would fit."""
    parts = ", ".join(f"{m.name} {math.ceil(m.bytes_per_s)}" for m in plan.running)
    fits = [
        *_slower_samples(plan, rate_hz),
        *_faster_link(plan, target),
        f"a design of about {rate_hz * plan.usable_bytes_s / plan.bytes_per_s:.0f} Hz",
    ]
    return (
        f"rate_hz = {rate_hz:g} needs {plan.bytes_per_s} bytes/s of telemetry ({parts}); "
        f"{plan.baud} baud carries {plan.usable_bytes_s} bytes/s at {USABLE_PERCENT} % use; "
        f"what fits: {', or '.join(fits)}"
    )


def _slower_samples(plan: LinkPlan, rate_hz: float) -> tuple[str, ...]:
    """Return the fastest rate of TILT_SAMPLE with which a plan fits, as an option."""
    sample = next(m for m in plan.messages if m.name == "TILT_SAMPLE")
    left = plan.usable_bytes_s - (plan.bytes_per_s - sample.bytes_per_s)
    if not sample.every or left <= 0.0:
        return ()
    every = math.ceil(rate_hz * sample.frame_bytes / left)
    slower = replace(sample, every=every, interval_us=every * round(1e6 / rate_hz))
    return (f"--message TILT_SAMPLE={slower.rate_hz:.6g}",)


def _faster_link(plan: LinkPlan, target: Target) -> tuple[str, ...]:
    """Return the slowest standard rate that carries a plan, as an option."""
    if target.uart is None:
        return ()
    usable = 100 * BITS_PER_BYTE / USABLE_PERCENT * plan.bytes_per_s
    rates = [rate for rate in target.uart.standard() if rate >= usable]
    return (f"--baud {rates[0]}",) if rates else ()
