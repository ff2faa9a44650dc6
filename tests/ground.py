"""A ground station: what it sends to a board, and what it hears of it."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from boards import Heard, hear, stimulus

from hostkit.dialect import python_module
from hostkit.emulation import host_board
from hostkit.emulation.board import BoardRun, LinkInput, Stimulus
from hostkit.units import STANDARD_GRAVITY_M_S2

M = python_module()
REAL32 = 9
GROUND = (255, 190)
SETTLED_S = 0.5
"""By then the samples come."""
ACCEPTED, TEMPORARILY_REJECTED, DENIED, UNSUPPORTED, FAILED, IN_PROGRESS = range(6)


def resting(samples: int, rate_rad_s: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Stimulus:
    """Level and still, with the noise of a good part, and a bias of the gyroscope."""
    rng = np.random.default_rng(7)
    return replace(
        stimulus(samples),
        angular_rate_rad_s=rng.normal(rate_rad_s, 8e-4, (samples, 3)),
        specific_force_m_s2=rng.normal((0.0, 0.0, STANDARD_GRAVITY_M_S2), 0.02, (samples, 3)),
    )


class Ground:
    """Collects what is to be sent, each at its time, and runs a board with it."""

    def __init__(self) -> None:
        self._mav = M.MAVLink(None, srcSystem=GROUND[0], srcComponent=GROUND[1])
        self._sent: list[LinkInput] = []

    def raw(self, time_s: float, data: bytes) -> None:
        self._sent.append(LinkInput(time_s=time_s, data=data))

    def frame(self, message: object) -> bytes:
        data = bytes(message.pack(self._mav))
        self._mav.seq = (self._mav.seq + 1) % 256
        return data

    def send(self, time_s: float, message: object) -> None:
        self.raw(time_s, self.frame(message))

    def set(self, time_s: float, name: str, value: float, *, to: tuple[int, int] = (1, 1)) -> None:
        self.send(time_s, M.MAVLink_param_set_message(*to, name.encode(), value, REAL32))

    def read(self, time_s: float, name: str, index: int = -1) -> None:
        self.send(time_s, M.MAVLink_param_request_read_message(1, 1, name.encode(), index))

    def list(self, time_s: float, to: tuple[int, int] = (1, 1)) -> None:
        self.send(time_s, M.MAVLink_param_request_list_message(*to))

    def command(
        self, time_s: float, number: int, *values: float, to: tuple[int, int] = (1, 1)
    ) -> None:
        seven = (*values, *(0.0,) * (7 - len(values)))
        self.send(time_s, M.MAVLink_command_long_message(*to, number, 0, *seven))

    def run(self, folder: Path, feels: Stimulus, **changes: object) -> "Heard":
        return hear(self.board_run(folder, feels, **changes))

    def board_run(self, folder: Path, feels: Stimulus, **changes: object) -> BoardRun:
        sent = tuple(sorted(self._sent, key=lambda piece: piece.time_s))
        return host_board.run(folder, replace(feels, received=sent, **changes))


def values(heard: Heard) -> list[tuple[str, float]]:
    """Return the parameters that were told, in order."""
    return [(m.param_id, m.param_value) for m in heard.of("PARAM_VALUE")]


def acks(heard: Heard) -> list[tuple[int, int]]:
    """Return the commands that were answered, and how."""
    return [(m.command, m.result) for m in heard.of("COMMAND_ACK")]


def texts(heard: Heard) -> list[str]:
    return [m.text for m in heard.of("STATUSTEXT")]
