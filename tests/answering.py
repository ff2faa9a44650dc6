"""A device in Python that answers as the firmware does, and a clock that no test waits for."""

from collections.abc import Callable
from typing import Any

import numpy as np

from hostkit.dialect import python_module
from hostkit.link.frames.decoder import Decoder, Frame

M = python_module()
OWN = {"SYS_ID": 1.0, "CAL_START": 0.0, "FILT_TAU": 2.75, "TILT_OFS_ROLL": 0.0}
RANGES = {"SYS_ID": (1, 254), "FILT_TAU": (0.001, 1000.0), "TILT_OFS_ROLL": (-0.5, 0.5)}


class ManualClock:
    def __init__(self) -> None:
        self.now_s = 100.0

    def monotonic(self) -> float:
        return self.now_s


class Sender:
    """Makes frames of one system as the decoder gives them, or as bytes."""

    def __init__(self, system: int = 1, component: int = 1) -> None:
        self._mav = M.MAVLink(None, srcSystem=system, srcComponent=component)
        self.source = (system, component)

    def pack(self, message: Any) -> bytes:
        data = bytes(message.pack(self._mav))
        self._mav.seq = (self._mav.seq + 1) % 256
        return data

    def frame(self, message: Any) -> Frame:
        return Decoder().feed(self.pack(message))[0]

    def value(self, name: str, value: float, index: int, count: int) -> Frame:
        return self.frame(M.MAVLink_param_value_message(name.encode(), value, 9, count, index))

    def sample(self, sequence: int = 0, *, rate_hz: float = 100.0) -> bytes:
        time_us = round(sequence * 1e6 / rate_hz)
        rest = (0, 0, [0] * 3, [0] * 3, 0, 0, [0] * 6, 0, [0, 0])
        return self.pack(M.MAVLink_tilt_sample_message(time_us, sequence, *rest))

    def heartbeat(self, kind: int = 0) -> bytes:
        return self.pack(M.MAVLink_heartbeat_message(kind, 0, 0, 0, 4, 3))


class AnsweringDevice:
    """A transport whose other end has parameters and commands; every read takes 10 ms.

    `hears` tells which requests reach it, `loses` which answers get lost.
    """

    live = True

    def __init__(self, clock: ManualClock, *, source: tuple[int, int] = (1, 1)) -> None:
        self.state, self.epoch, self.overrun_bytes = "connected", 0, 0
        self.clock = clock
        self.sender = Sender(*source)
        self.values = dict(OWN)
        self.commands: list[tuple[int, int, int]] = []
        self.asked: list[str] = []
        self.results = [0]
        self.hears: Callable[[Any], bool] = lambda message: True
        self.loses: Callable[[Any], bool] = lambda message: False
        self.rounded: Callable[[float], float] = lambda value: value
        self.silent = False
        self.closed = False
        self._decoder = Decoder()
        self._out = b""
        self._sequence = 0

    def read(self, timeout_s: float) -> bytes | None:
        self.clock.now_s += 0.01
        if not self.silent:
            self._out += self.sender.sample(self._sequence)
            self._sequence += 1
        out, self._out = self._out, b""
        return out

    def write(self, data: bytes) -> None:
        for frame in self._decoder.feed(data):
            self.asked.append(frame.name)
            if self.hears(frame.message):
                self.hear(frame.message)

    def close(self) -> None:
        self.closed = True

    def answer(self, message: Any) -> None:
        if not self.loses(message):
            self._out += self.sender.pack(message)

    def tell(self, name: str) -> None:
        place, count = list(self.values).index(name), len(self.values)
        value = self.values[name]
        self.answer(M.MAVLink_param_value_message(name.encode(), value, 9, count, place))

    def hear(self, message: Any) -> None:
        kind = message.get_type()
        if (message.target_system, message.target_component) != self.sender.source:
            return
        if kind == "PARAM_REQUEST_LIST":
            for name in self.values:
                self.tell(name)
        elif kind == "PARAM_REQUEST_READ":
            self.tell(list(self.values)[message.param_index])
        elif kind == "PARAM_SET":
            self._set(message.param_id, message.param_value)
        elif kind == "COMMAND_LONG":
            self.commands.append((message.command, int(message.param1), message.confirmation))
            for result in self.results:
                self.answer(M.MAVLink_command_ack_message(message.command, result))

    def _set(self, name: str, value: float) -> None:
        if name not in self.values:
            return
        lowest, highest = RANGES.get(name, (0.0, 1.0))
        if lowest <= value <= highest:
            self.values[name] = float(np.float32(self.rounded(value)))
        self.tell(name)
