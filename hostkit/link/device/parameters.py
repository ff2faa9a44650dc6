"""The parameters of a device: read, set, and told back, whatever the link does meanwhile."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

from hostkit.dialect import python_module
from hostkit.errors import HostkitError
from hostkit.link.device.exchange import MonotonicClock, Send
from hostkit.link.device.listing import MOST_PARAMETERS, Listing
from hostkit.link.device.parameter_entry import ParameterEntry, as_real32, is_name, near
from hostkit.link.device.parameter_facts import ParameterFacts, parameter_facts
from hostkit.link.frames.decoder import Frame, Source

__all__ = ["ParameterClient", "ParameterEntry"]

ANSWER_WAIT_S = 0.5
TRIES = 4
"""How often a value is sent until it is given up."""

REAL32 = 9


@dataclass(slots=True, kw_only=True)
class _Setting:
    """A value on its way."""

    name: str
    value: float
    before: float | None
    sent_s: float
    tries: int = 1
    doubted: bool = False


class ParameterClient:
    """Speaks MAVLink's parameter protocol with one device; has no thread and never waits.

    Values are set one after the other: a small board hears a few frames at once only. Of several
    values for one name the newest counts. What the device tells is the truth.

    Parameters
    ----------
    send
        Takes the messages to the device.
    clock
        What time it is.
    target
        The device. Without it, the first sender of a TILT_SAMPLE; nothing is sent until then.
    facts
        What is known of the parameters, for messages about their limits.

    Attributes
    ----------
    target
        The device, None while there is none.
    refused
        Messages that were not taken: no name, no number, or more than anyone has.
    """

    def __init__(
        self,
        send: Send,
        clock: MonotonicClock,
        *,
        target: Source | None = None,
        facts: Mapping[str, ParameterFacts] | None = None,
    ) -> None:
        self._send = send
        self._clock = clock
        self.target = target
        self._facts = parameter_facts() if facts is None else facts
        self.refused = 0
        self._entries: dict[str, ParameterEntry] = {}
        self._listing = Listing()
        self._queue: dict[str, float] = {}
        self._flight: _Setting | None = None
        self._failures: dict[str, str] = {}

    @property
    def entries(self) -> Mapping[str, ParameterEntry]:
        """The parameters told so far by their names, in the order of their coming."""
        return MappingProxyType(self._entries)

    @property
    def failures(self) -> Mapping[str, str]:
        """Why settings failed of names that the device never told."""
        return MappingProxyType(self._failures)

    @property
    def complete(self) -> bool:
        """Whether the whole list has come."""
        return self._listing.complete

    @property
    def listing(self) -> bool:
        """Whether the list is still being fetched."""
        return self._listing.active

    @property
    def listing_error(self) -> str:
        """Why the list was given up; empty if it was not."""
        return self._listing.error

    @property
    def setting(self) -> bool:
        """Whether a value is on its way or waits."""
        return self._flight is not None or bool(self._queue)

    def attend(self, target: Source) -> None:
        """Speak with this device from now on; what another one told is forgotten."""
        if self.target not in (None, target):
            self._entries.clear()
        self.target = target

    def begin_epoch(self) -> None:
        """Take note that the port was opened anew: what was on its way is lost, lists restart."""
        for name in (*self._queue, *([self._flight.name] if self._flight else [])):
            self._fail(name, "the link was lost before the device answered")
        self._queue.clear()
        self._flight = None
        if self._listing.active or self._entries:
            self.request_all()

    def request_all(self) -> None:
        """Ask for the whole list."""
        self._listing.begin(self._clock.monotonic())

    def set(self, name: str, value: float) -> None:
        """Ask the device to use a value.

        Raises
        ------
        HostkitError
            If the device has no such parameter, or the value is no finite number of 32 bits.
        """
        if not is_name(name):
            raise HostkitError(f"{name!r} is no name of a parameter: 1 to 16 printable characters")
        if self.complete and name not in self._entries:
            raise HostkitError(
                f"the device has no parameter {name!r}; it has: " + ", ".join(self._entries)
            )
        if len(self._queue) >= MOST_PARAMETERS and name not in self._queue:
            raise HostkitError(f"{MOST_PARAMETERS} values wait to be set already; wait for them")
        number = as_real32(name, value)
        self._failures.pop(name, None)
        self._queue[name] = number
        self._note(name, wanted=number, error="")

    def take(self, frame: Frame) -> None:
        """Take any frame that came; copies and those that are not of the device are passed over."""
        if self.target is None and frame.name == "TILT_SAMPLE":
            self.target = frame.source
        if frame.name != "PARAM_VALUE" or frame.source != self.target or frame.repeated:
            return
        message = frame.message
        name, value = str(message.param_id), float(message.param_value)
        index, count = int(message.param_index), int(message.param_count)
        if not is_name(name) or not self._has_room(name):
            self.refused += 1
            return
        self._listing.take(index, count, self._clock.monotonic())
        if not math.isfinite(value):
            self.refused += 1
            self._note(name, error=f"the device told {value}, which is no value")
            return
        before = self._entries.get(name)
        if before is None:
            self._entries[name] = ParameterEntry(name=name, value=value, index=index)
        else:
            place = before.index if index >= count else index
            self._entries[name] = replace(before, value=value, index=place)
        self._settle(name, value)

    def poll(self) -> None:
        """Send what is due; call it a few times a second at least."""
        if self.target is None:
            return
        now_s = self._clock.monotonic()
        self._poll_listing(now_s)
        flight = self._flight
        if flight is None:
            self._start_next(now_s)
        elif now_s - flight.sent_s >= ANSWER_WAIT_S:
            if flight.tries == TRIES:
                self._flight = None
                self._fail(flight.name, f"the device did not answer {TRIES} requests")
            else:
                self._send_setting(flight, now_s)

    def _has_room(self, name: str) -> bool:
        return name in self._entries or len(self._entries) < MOST_PARAMETERS

    def _poll_listing(self, now_s: float) -> None:
        due = self._listing.due(now_s)
        if due is None or self.target is None:
            return
        dialect = python_module()
        if not due:
            self._send(dialect.MAVLink_param_request_list_message(*self.target))
        for index in due:
            self._send(dialect.MAVLink_param_request_read_message(*self.target, b"", index))

    def _start_next(self, now_s: float) -> None:
        if not self._queue:
            return
        name = next(iter(self._queue))
        entry = self._entries.get(name)
        self._flight = _Setting(
            name=name,
            value=self._queue.pop(name),
            before=None if entry is None else entry.value,
            sent_s=now_s,
            tries=0,
        )
        self._send_setting(self._flight, now_s)

    def _send_setting(self, setting: _Setting, now_s: float) -> None:
        assert self.target is not None
        setting.sent_s = now_s
        setting.tries += 1
        self._send(
            python_module().MAVLink_param_set_message(
                *self.target, setting.name.encode(), setting.value, REAL32
            )
        )

    def _settle(self, name: str, told: float) -> None:
        """Take what was told as the answer to what was set, if it is one.

        The old value may belong to a list that is on its way, so it is asked for once more.
        """
        flight = self._flight
        if flight is None or flight.name != name:
            return
        if not near(told, flight.value):
            if not flight.doubted:
                flight.doubted = True
                flight.tries = min(flight.tries, TRIES - 1)
                self._send_setting(flight, self._clock.monotonic())
                return
            self._flight = None
            self._fail(name, self._why(name, told, flight))
        else:
            self._flight = None
            self._note(name, wanted=self._queue.get(name), error="")
        self._start_next(self._clock.monotonic())

    def _why(self, name: str, told: float, setting: _Setting) -> str:
        facts = self._facts.get(name)
        unit = f" {facts.unit}" if facts is not None and facts.unit else ""
        keeps = "keeps" if told == setting.before else "answered with"
        text = f"asked for {setting.value:.9g}{unit}, the device {keeps} {told:.9g}{unit}"
        takes = "" if facts is None else facts.range_text()
        return f"{text}; it takes {takes}" if takes else text

    def _fail(self, name: str, error: str) -> None:
        if name in self._entries:
            self._note(name, wanted=self._queue.get(name), error=error)
        else:
            self._failures[name] = error

    def _note(self, name: str, *, error: str, wanted: float | None = None) -> None:
        entry = self._entries.get(name)
        if entry is not None:
            self._entries[name] = replace(entry, wanted=wanted, error=error)
