"""What a session says to the device: who it is, what time it is, what it wants to know."""

from collections.abc import Mapping
from typing import Any, Final

from hostkit.dialect import python_module
from hostkit.errors import HostkitError
from hostkit.link.clock import Clock
from hostkit.link.device.commands import CommandClient
from hostkit.link.device.parameter_facts import ParameterFacts, parameter_facts
from hostkit.link.device.parameters import ParameterClient, ParameterEntry
from hostkit.link.frames.decoder import Frame, Source
from hostkit.link.frames.encoder import Encoder
from hostkit.link.ports.transport import Transport
from hostkit.monitor.notices import Notices
from hostkit.monitor.snapshot import CommandState, Level, ParameterState
from hostkit.records import FilterDesign

HEARTBEAT_EVERY_S = 1.0
VERSION_EVERY_S = 2.0
LIST_EVERY_S = 2.0
VERSION_TRIES = 5
STATE_EVERY_S = 0.3
"""A state that is asked for comes with one of the next samples."""

STATION_TYPE, NO_AUTOPILOT, MAVLINK_VERSION = 6, 8, 3
REQUEST_MESSAGE, AUTOPILOT_VERSION = 512, 148
CALIBRATED: Final = "calibrate"


class Conversation:
    """Speaks with one device; with `silent` it only listens, as to a recorded one.

    Parameters
    ----------
    silent
        Whether nothing at all is sent.
    """

    def __init__(
        self,
        transport: Transport,
        encoder: Encoder,
        clock: Clock,
        notices: Notices,
        design: FilterDesign,
        *,
        silent: bool,
    ) -> None:
        self._transport, self._encoder, self._clock = transport, encoder, clock
        self._notices, self._silent = notices, silent
        self._period_s = design.period_s
        self._facts: Mapping[str, ParameterFacts] = parameter_facts(design)
        self._parameters = ParameterClient(self.send, clock, facts=self._facts)
        self._commands = CommandClient(self.send, clock)
        self._target: Source | None = None
        self._next_heartbeat_s = self._next_version_s = clock.monotonic()
        self._version_tries = 0
        self._command_told: CommandState | None = None
        self._next_list_s = self._next_state_s = 0.0

    def send(self, message: Any) -> None:
        """Send a message of the dialect, unless nothing is to be sent."""
        if not self._silent:
            self._transport.write(self._encoder.pack(message))

    def pass_on(self, raw: bytes) -> None:
        """Send a frame of another station."""
        if not self._silent:
            self._transport.write(raw)

    def attend(self, source: Source) -> None:
        """Speak with a device from now on; does nothing if it is the same."""
        if source == self._target:
            return
        self._target = source
        self._parameters.attend(source)
        self._commands.attend(source)
        if not self._silent:
            self._parameters.request_all()

    def begin_epoch(self) -> None:
        """Take note that the device or the port began anew."""
        self._version_tries = 0
        self._parameters.begin_epoch()
        self._commands.begin_epoch()

    def learn(self, untold: tuple[str, ...]) -> None:
        """Ask for all parameters, now and then, while the device has not told some that it uses."""
        now_s = self._clock.monotonic()
        due = now_s >= self._next_list_s and not self._silent
        if untold and due and not self._parameters.listing:
            self._next_list_s = now_s + LIST_EVERY_S
            self._parameters.request_all()

    def take(self, frame: Frame) -> None:
        """Take any frame that came."""
        if frame.name == "PARAM_VALUE":
            self._parameters.take(frame)
        elif frame.name == "COMMAND_ACK":
            self._commands.take(frame)
            self._follow_command()
        elif frame.name == "AUTOPILOT_VERSION" and frame.source == self._target:
            self._version_tries = VERSION_TRIES

    def learn_state(self, needed: bool) -> None:
        """Ask for the state of the filter while it is needed."""
        now_s = self._clock.monotonic()
        if self._silent or not needed or self._target is None or now_s < self._next_state_s:
            return
        self._next_state_s = now_s + STATE_EVERY_S
        self._request(python_module().MAVLINK_MSG_ID_TILT_STATE)

    def poll(self) -> None:
        """Send what is due."""
        if self._silent:
            return
        now_s = self._clock.monotonic()
        if now_s >= self._next_heartbeat_s:
            self._next_heartbeat_s = now_s + HEARTBEAT_EVERY_S
            self.send(_heartbeat())
        self._ask_version(now_s)
        self._parameters.poll()
        self._commands.poll()
        self._follow_command()

    def set_parameter(self, name: str, value: float) -> None:
        """Ask the device to use a value; what becomes of it shows in the parameters."""
        try:
            self._parameters.set(name, value)
        except HostkitError as error:
            self._notices.add("error", str(error))

    def revert(self) -> None:
        """Ask the device for the design's values of its filter."""
        for name, entry in self._parameters.entries.items():
            facts = self._facts.get(name)
            wanted = None if facts is None else facts.design_value
            if wanted is not None and (entry.value != wanted or entry.wanted is not None):
                self.set_parameter(name, wanted)

    def command(self, name: str) -> None:
        """Send a command."""
        try:
            self._commands.send(name)
        except HostkitError as error:
            self._notices.add("error", str(error))

    def parameters(self) -> tuple[ParameterState, ...]:
        """Return the parameters that the device told, in its order."""
        entries = sorted(self._parameters.entries.values(), key=lambda entry: entry.index)
        return tuple(self._state_of(entry) for entry in entries)

    def command_state(self) -> CommandState | None:
        """Return the last command and its answer."""
        status = self._commands.state
        if status is None:
            return None
        return CommandState(name=status.name, state=status.state, detail=status.detail)

    def _state_of(self, entry: ParameterEntry) -> ParameterState:
        facts = self._facts.get(entry.name)
        return ParameterState(
            name=entry.name,
            value=entry.value,
            unit="" if facts is None else facts.unit,
            design_value=None if facts is None else facts.design_value,
            lowest=None if facts is None else facts.lowest,
            highest=None if facts is None else facts.highest,
            wanted=entry.wanted,
            error=entry.error,
            symbol="" if facts is None else facts.symbol,
            title="" if facts is None else facts.title,
            views=() if facts is None else facts.views(self._period_s),
        )

    def _follow_command(self) -> None:
        """Tell once how a command ended; values may be others after it."""
        state = self.command_state()
        if state is None or state == self._command_told:
            return
        self._command_told = state
        if state.state in ("waiting", "in progress"):
            return
        level: Level = "info" if state.state == "accepted" else "error"
        detail = f": {state.detail}" if state.detail else ""
        self._notices.add(level, f"{state.name}: {state.state}{detail}")
        if state.state == "accepted" and state.name in (CALIBRATED, "defaults"):
            self._parameters.request_all()

    def _ask_version(self, now_s: float) -> None:
        due = self._target is not None and now_s >= self._next_version_s
        if not due or self._version_tries >= VERSION_TRIES or self._target is None:
            return
        self._version_tries += 1
        self._next_version_s = now_s + VERSION_EVERY_S
        self._request(AUTOPILOT_VERSION)

    def _request(self, message_id: int) -> None:
        assert self._target is not None
        values = (message_id, 0, 0, 0, 0, 0, 0)
        dialect = python_module()
        self.send(dialect.MAVLink_command_long_message(*self._target, REQUEST_MESSAGE, 0, *values))


def _heartbeat() -> Any:
    return python_module().MAVLink_heartbeat_message(
        STATION_TYPE, NO_AUTOPILOT, 0, 0, 0, MAVLINK_VERSION
    )
