"""A session with a device whose telling of a parameter is lost on the way."""

import numpy as np
import pytest
from designs import design
from device import Device

from hostkit.dialect import python_module
from hostkit.link.frames.decoder import Decoder
from hostkit.monitor import Session
from hostkit.validation import Thresholds, device_parameters

SAMPLES = 600
PERIOD_S = 0.01
D = design()
CHANGES = {100: {"TILT_OFS_ROLL": 0.02}, 300: {"FILT_TAU": 2.0}}


class Port:
    """A device on a link that loses one frame; it answers when all parameters are asked for."""

    live, state, epoch, overrun_bytes = True, "connected", 0, 0

    def __init__(self, lost: str) -> None:
        self.now_s, self.lost, self._asked = 0.0, lost, False
        self._device, self._link = Device(D), python_module().MAVLink(None, srcSystem=1)
        self._heard = python_module().MAVLink(None)
        self._frames = Decoder().feed(b"".join(self._device.retuned_frames(SAMPLES, CHANGES)))
        self._told = {p.name: p.design_value for p in device_parameters(D)}

    def monotonic(self) -> float:
        return self.now_s

    def time(self) -> float:
        return 1.7e9 + self.now_s

    def read(self, timeout_s: float) -> bytes:
        self.now_s += PERIOD_S
        data = b""
        while self._frames:
            message = self._frames.pop(0).message
            if message.get_type() == "PARAM_VALUE":
                self._told[message.param_id] = message.param_value
                data += self._pack(message, lost=message.param_id == self.lost)
            else:
                return data + self._pack(message)
        return data

    def write(self, data: bytes) -> None:
        for message in self._heard.parse_buffer(data) or []:
            if message.get_type() == "PARAM_REQUEST_LIST":
                values = [
                    python_module().MAVLink_param_value_message(name.encode(), value, 9, 5, i)
                    for i, (name, value) in enumerate(self._told.items())
                ]
                self._frames[:0] = Decoder().feed(b"".join(v.pack(self._link) for v in values))
                self.lost = "" if self._asked else self.lost
                self._asked = True

    def close(self) -> None:
        pass

    def _pack(self, message, *, lost: bool = False) -> bytes:
        frame = bytes(message.pack(self._device.mav))
        self._device.mav.seq = (self._device.mav.seq + 1) % 256
        return b"" if lost else frame


@pytest.mark.parametrize("lost", ["", "TILT_OFS_ROLL", "FILT_TAU"])
def test_a_parameter_that_was_lost_on_the_way_is_asked_for_and_fails_nobody(lost: str) -> None:
    port = Port(lost)
    duration_s = PERIOD_S * (SAMPLES - 5)
    session = Session(
        design=D, transport=port, thresholds=Thresholds(), clock=port, duration_s=duration_s
    )
    report = session.run().report
    assert (report.verdict, report.reasons) == ("pass", ())
    assert (report.mismatches, report.untold) == (0, ())
    assert {p.name for p in report.retuned} == {"TILT_OFS_ROLL", "FILT_TAU"}
    assert (report.unjudged > 0) == bool(lost)
    assert np.isclose(report.retuned[0].device_value, 2.0)
