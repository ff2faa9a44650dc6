"""One device at a port, spoken with by a program that waits for its answers."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import TracebackType
from typing import Any, Final

from hostkit.errors import DeviceError, HostkitError
from hostkit.link.clock import SystemClock
from hostkit.link.device.commands import CommandClient, CommandStatus
from hostkit.link.device.exchange import MonotonicClock
from hostkit.link.device.parameter_entry import ParameterEntry
from hostkit.link.device.parameter_facts import ParameterFacts
from hostkit.link.device.parameters import ParameterClient
from hostkit.link.device.presence import Presence
from hostkit.link.frames.decoder import Decoder, Frame, Source
from hostkit.link.frames.encoder import Encoder
from hostkit.link.frames.signing import SigningKey
from hostkit.link.ports.transport import Transport

POLL_S = 0.05
FIND_S = 5.0
"""How long to wait for a device: a heartbeat comes once a second."""

SETTLE_S = 1.5
"""How long after the first heartbeat to wait for a TILT_SAMPLE, which says who is meant."""

LISTING_S = 120.0
SETTING_S = 10.0
COMMAND_S = 90.0

KEY_WANTED: Final = "the device signs its messages and hears signed ones only; give --signing-key"


@dataclass(frozen=True, slots=True, kw_only=True)
class SettingOutcome:
    """What became of a value that was to be set.

    Attributes
    ----------
    in_use
        What the device told last; None if it never told anything.
    error
        Why it did not take; empty if it did.
    """

    name: str
    asked: float
    in_use: float | None
    error: str


class DeviceLink:
    """A transport with a device behind it; closed at the end of a ``with`` block.

    Parameters
    ----------
    system
        System id of the device; None where there is one only.
    facts
        What is known of its parameters.
    signing
        Key of a device that knows signed messages only; others are then not listened to.

    Attributes
    ----------
    parameters, commands
        The clients that speak with it.
    """

    def __init__(
        self,
        transport: Transport,
        *,
        system: int | None = None,
        facts: Mapping[str, ParameterFacts] | None = None,
        signing: SigningKey | None = None,
        clock: MonotonicClock | None = None,
    ) -> None:
        self._transport = transport
        self._clock = SystemClock() if clock is None else clock
        self.parameters = ParameterClient(self.send, self._clock, facts=facts)
        self.commands = CommandClient(self.send, self._clock)
        self._system = system
        self.use_key(signing)
        self._epoch = transport.epoch

    def __enter__(self) -> "DeviceLink":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._transport.close()

    @property
    def digest(self) -> str | None:
        """Digest of the device's design; None while it has sent no sample."""
        return self._presence.digest

    @property
    def rate_hz(self) -> float | None:
        """Sample rate by the device's own time; None while too little has come."""
        return self._presence.rate_hz

    @property
    def heard(self) -> bool:
        """Whether a device was heard that is believed."""
        return self._presence.sampling is not None or bool(self._presence.heard)

    @property
    def signed(self) -> bool:
        """Whether the latest that was heard of the device was signed, with whatever key."""
        return self._presence.signed

    def use_key(self, signing: SigningKey | None) -> None:
        """Speak with a key from now on, or with None without one; who was heard is forgotten."""
        self._encoder, self._decoder = Encoder(signing), Decoder(signing)
        self._presence = Presence(system=self._system)
        self._has_key = signing is not None

    def find(self) -> Source:
        """Wait for the device and return its system and component.

        Raises
        ------
        DeviceError
            If none is heard in 5 s, or it cannot be told which one is meant.
        """
        begun_s = self._clock.monotonic()

        def found() -> bool:
            waited = self._clock.monotonic() - begun_s
            return self._presence.sampling is not None or (self.heard and waited >= SETTLE_S)

        if not self.wait(found, FIND_S):
            raise DeviceError(self._presence.nobody(FIND_S, self._decoder.statistics()))
        source = self._presence.device()
        self._system = source[0]
        self.parameters.attend(source)
        self.commands.attend(source)
        return source

    def fetch(self) -> tuple[ParameterEntry, ...]:
        """Return all parameters of the device, in its own order.

        Raises
        ------
        DeviceError
            If some of them were not told.
        """
        self.parameters.request_all()
        self.wait(lambda: not self.parameters.listing, LISTING_S)
        if not self.parameters.complete:
            if self.signed and not self._has_key:
                raise DeviceError(KEY_WANTED)
            error = self.parameters.listing_error or f"no list came in {LISTING_S:g} s"
            raise DeviceError(error)
        return tuple(sorted(self.parameters.entries.values(), key=lambda entry: entry.index))

    def set(self, values: Mapping[str, float]) -> tuple[SettingOutcome, ...]:
        """Set values, wait for all the answers and return them in the same order.

        Raises
        ------
        HostkitError
            If there is no such parameter or a value is none; nothing is set then.
        """
        for name, value in values.items():
            self.parameters.set(name, value)
        self.wait(lambda: not self.parameters.setting, SETTING_S * max(1, len(values)))
        return tuple(self._outcome(name, value) for name, value in values.items())

    def run(self, command: str) -> CommandStatus:
        """Send a command, wait until it is over and return how it went.

        Raises
        ------
        DeviceError
            If the device does not answer.
        HostkitError
            If it refuses.
        """
        self.commands.send(command)
        self.wait(lambda: self.commands.state is not None and self.commands.state.over, COMMAND_S)
        state = self.commands.state
        assert state is not None
        if state.state == "refused":
            raise HostkitError(f"the device refused {command}: {state.detail}")
        if state.state != "accepted":
            raise DeviceError(f"the device did not answer {command}: {state.detail}")
        return state

    def wait(self, done: Callable[[], bool], timeout_s: float) -> bool:
        """Take what comes and send what is due until `done`; tell whether it came to that.

        Raises
        ------
        DeviceError
            If the device goes away.
        """
        deadline_s = self._clock.monotonic() + timeout_s
        while not done():
            if self._clock.monotonic() >= deadline_s:
                return False
            self.parameters.poll()
            self.commands.poll()
            data = self._transport.read(POLL_S)
            if data is None:
                raise DeviceError("the device went away; check its cable and power")
            self._notice_epoch()
            for frame in self._decoder.feed(data):
                self._take(frame)
        return True

    def send(self, message: Any) -> None:
        """Send a message of the dialect."""
        self._transport.write(self._encoder.pack(message))

    def _notice_epoch(self) -> None:
        if self._transport.epoch != self._epoch:
            self._epoch = self._transport.epoch
            self._decoder.begin_epoch()
            self.parameters.begin_epoch()
            self.commands.begin_epoch()
            self._presence.begin_epoch()

    def _take(self, frame: Frame) -> None:
        if not self._presence.take(frame):
            return
        self.parameters.take(frame)
        self.commands.take(frame)

    def _outcome(self, name: str, asked: float) -> SettingOutcome:
        entry = self.parameters.entries.get(name)
        error = self.parameters.failures.get(name, "") if entry is None else entry.error
        if not error and (entry is None or entry.wanted is not None):
            error = "the device did not answer in time"
        in_use = None if entry is None else entry.value
        return SettingOutcome(name=name, asked=asked, in_use=in_use, error=error)
