"""Commands to a device: sent, repeated, and answered."""

from dataclasses import dataclass
from typing import Final, Literal

from hostkit.dialect import python_module
from hostkit.errors import HostkitError
from hostkit.link.device.exchange import EVERYBODY, STATION, MonotonicClock, Send
from hostkit.link.frames.decoder import Frame, Source

ANSWER_WAIT_S = 1.0
PROGRESS_WAIT_S = 60.0
"""How long a command may be in progress without a word: ten windows of calibration, and more."""

TRIES = 4

ACCEPTED, IN_PROGRESS = 0, 5
RESULTS: Final = {
    1: "not now; try again",
    2: "denied",
    3: "not supported",
    4: "failed",
    6: "cancelled",
}

CommandStage = Literal["waiting", "in progress", "accepted", "refused", "no answer"]


@dataclass(frozen=True, slots=True, kw_only=True)
class DeviceCommand:
    """A command of the device: its number and its seven parameters."""

    number: int
    values: tuple[float, float, float, float, float, float, float]


def _command(number: int, first: float) -> DeviceCommand:
    return DeviceCommand(number=number, values=(first, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))


COMMANDS: Final = {
    "calibrate": _command(241, 1.0),
    "self-test": _command(31010, 0.0),
    "store": _command(245, 1.0),
    "defaults": _command(245, 2.0),
    "reboot": _command(246, 1.0),
}
"""What they do: `store` keeps the parameters, `defaults` returns to those of the design."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CommandStatus:
    """The last command, and what became of it."""

    name: str
    state: CommandStage
    detail: str = ""

    @property
    def over(self) -> bool:
        """Tell whether nothing more is waited for."""
        return self.state not in ("waiting", "in progress")


class CommandClient:
    """Sends one command at a time; has no thread and never waits.

    Parameters
    ----------
    send
        Takes the messages to the device.
    clock
        What time it is.
    target
        The device. Without it, the first sender of a TILT_SAMPLE.

    Attributes
    ----------
    target
        The device, None while there is none.
    state
        The last command, None before the first.
    """

    def __init__(self, send: Send, clock: MonotonicClock, *, target: Source | None = None) -> None:
        self._send = send
        self._clock = clock
        self.target = target
        self.state: CommandStatus | None = None
        self._sent_s = 0.0
        self._tries = 0

    def attend(self, target: Source) -> None:
        """Speak with this device from now on."""
        self.target = target

    def begin_epoch(self) -> None:
        """Take note that the port was opened anew: an answer will not come any more."""
        if self.state is not None and not self.state.over:
            self._become("no answer", "the link was lost")

    def send(self, name: str) -> None:
        """Send a command by its name.

        Raises
        ------
        HostkitError
            If there is no such command, another one is still waited for, or no device is known.
        """
        if name not in COMMANDS:
            raise HostkitError(f"no command {name!r}; there are: {', '.join(COMMANDS)}")
        if self.state is not None and not self.state.over:
            raise HostkitError(f"{self.state.name} is still {self.state.state}; wait for it")
        if self.target is None:
            raise HostkitError(f"{name} cannot be sent: no device has been heard yet")
        self.state = CommandStatus(name=name, state="waiting")
        self._tries = 0
        self._transmit(self.target)

    def take(self, frame: Frame) -> None:
        """Take any frame that came; copies and those that are no answer are passed over."""
        if self.target is None and frame.name == "TILT_SAMPLE":
            self.target = frame.source
        state = self.state
        if frame.name != "COMMAND_ACK" or frame.source != self.target or frame.repeated:
            return
        if state is None or state.over or not self._is_answer(frame, state.name):
            return
        result = int(frame.message.result)
        if result == IN_PROGRESS:
            self._sent_s = self._clock.monotonic()
            self._become("in progress", "")
        elif result == ACCEPTED:
            self._become("accepted", "")
        else:
            self._become("refused", RESULTS.get(result, f"answered with result {result}"))

    def poll(self) -> None:
        """Repeat what was not answered in time; call it a few times a second."""
        state = self.state
        if state is None or state.over or self.target is None:
            return
        waited_s = self._clock.monotonic() - self._sent_s
        if state.state == "in progress":
            if waited_s >= PROGRESS_WAIT_S:
                self._become("no answer", f"in progress for {PROGRESS_WAIT_S:g} s without a word")
        elif waited_s >= ANSWER_WAIT_S:
            if self._tries == TRIES:
                self._become("no answer", f"not answered {TRIES} times")
            else:
                self._transmit(self.target)

    def _become(self, state: CommandStage, detail: str) -> None:
        assert self.state is not None
        self.state = CommandStatus(name=self.state.name, state=state, detail=detail)

    def _transmit(self, target: Source) -> None:
        """Send the command with the number of times that it was sent before."""
        assert self.state is not None
        command = COMMANDS[self.state.name]
        self._sent_s = self._clock.monotonic()
        message = python_module().MAVLink_command_long_message(
            *target, command.number, self._tries, *command.values
        )
        self._tries += 1
        self._send(message)

    def _is_answer(self, frame: Frame, name: str) -> bool:
        """Tell whether an acknowledgement is of our command, not of another station's."""
        message = frame.message
        to = (int(message.target_system), int(message.target_component))
        ours = to[0] in (EVERYBODY, STATION[0]) and to[1] in (EVERYBODY, STATION[1])
        return ours and int(message.command) == COMMANDS[name].number
