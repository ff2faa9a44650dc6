"""Samples as JSON over UDP, as PlotJuggler and other plotters read them."""

import json
import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from hostkit.link.ports.addresses import open_udp, resolve_udp
from hostkit.records import Axis

LARGEST_SLIP_S = 0.5
"""How far the host's time of a sample may be off before it is set anew."""


class Samples(Protocol):
    """Samples beside their models, as a session hands them out; angles of shape ``(N, A)``."""

    @property
    def time_s(self) -> NDArray[np.float64]:
        """Device time, shape ``(N,)``."""

    @property
    def received_s(self) -> float:
        """Host time of arrival, seconds since 1970."""

    @property
    def device_rad(self) -> NDArray[np.float64]:
        """Angles of the device."""

    @property
    def model_rad(self) -> NDArray[np.float64]:
        """Angles of the float model, NaN where it could not follow."""

    @property
    def residual_rad(self) -> NDArray[np.float64]:
        """Their difference."""

    @property
    def mismatch(self) -> NDArray[np.bool_]:
        """Whether the integer model says another thing, shape ``(N,)``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class JsonCounts:
    """Samples that went to a plotter, and those that did not."""

    address: str
    sent: int
    dropped: int


class JsonUdp:
    """Sends one JSON object per sample and datagram; it never waits.

    PlotJuggler's UDP server takes one object per datagram and its ``timestamp`` in seconds. The
    time is the host's, as even as the device's; it is set anew when they are 0.5 s apart.

    Parameters
    ----------
    address
        ``udp:HOST:PORT``.
    axes
        What the columns of the angles are.

    Raises
    ------
    DeviceError
        If the address is none, or cannot be reached.
    """

    def __init__(self, address: str, axes: tuple[Axis, ...]) -> None:
        self._socket = open_udp(resolve_udp(address))
        self._address = address
        self._axes = axes
        self._begin_s: float | None = None
        self._sent = self._dropped = 0

    def send(self, samples: Samples) -> None:
        """Send samples, or drop those that the system does not take."""
        if not len(samples.time_s):
            return
        begin_s = self._begin(float(samples.time_s[-1]), samples.received_s)
        for text in self._texts(samples, begin_s):
            self._send(text.encode("ascii"))

    def state(self) -> JsonCounts:
        """Return the account so far."""
        return JsonCounts(address=self._address, sent=self._sent, dropped=self._dropped)

    def close(self) -> None:
        """Close the socket."""
        self._socket.close()

    def _begin(self, newest_s: float, received_s: float) -> float:
        """Return the host's time at which the device's time is 0."""
        begin_s = received_s - newest_s
        if self._begin_s is None or abs(begin_s - self._begin_s) > LARGEST_SLIP_S:
            self._begin_s = begin_s
        return self._begin_s

    def _texts(self, samples: Samples, begin_s: float) -> list[str]:
        angles = [
            (axis, *(np.degrees(values[:, i]).tolist() for values in _angles(samples)))
            for i, axis in enumerate(self._axes)
        ]
        texts = []
        for k, (time_s, mismatch) in enumerate(
            zip(samples.time_s.tolist(), samples.mismatch.tolist(), strict=True)
        ):
            row: dict[str, object] = {
                "timestamp": round(begin_s + time_s, 6),
                "device_time_s": round(time_s, 6),
                "mismatch": int(mismatch),
            }
            for axis, device, model, residual in angles:
                row[axis] = _finite(device[k], model[k], residual[k])
            texts.append(json.dumps(row, separators=(",", ":"), allow_nan=False))
        return texts

    def _send(self, datagram: bytes) -> None:
        try:
            self._socket.send(datagram)
        except OSError:
            self._dropped += 1
        else:
            self._sent += 1


def _angles(samples: Samples) -> tuple[NDArray[np.float64], ...]:
    return samples.device_rad, samples.model_rad, samples.residual_rad


def _finite(device: float, model: float, residual: float) -> dict[str, float]:
    """Return what there is: JSON has no word for what is no number."""
    named = {"device_deg": device, "model_deg": model, "residual_deg": residual}
    return {name: value for name, value in named.items() if math.isfinite(value)}
