"""Samples as a plotter reads them."""

import json
import socket
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import pytest

from hostkit.errors import DeviceError
from hostkit.link.json_udp import JsonUdp


@dataclass
class Rows:
    time_s: np.ndarray
    received_s: float
    device_rad: np.ndarray
    model_rad: np.ndarray
    residual_rad: np.ndarray
    mismatch: np.ndarray


def rows(times: list[float], received_s: float, axes: int = 2) -> Rows:
    time_s = np.array(times)
    device = np.outer(time_s, np.arange(1, axes + 1)) / 10
    return Rows(time_s, received_s, device, device - 0.001, 0 * device + 0.001, time_s > 1.0)


@pytest.fixture
def plotter() -> Iterator[socket.socket]:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as listening:
        listening.bind(("127.0.0.1", 0))
        listening.settimeout(5.0)
        yield listening


def address(plotter: socket.socket) -> str:
    return f"udp:127.0.0.1:{plotter.getsockname()[1]}"


def heard(plotter: socket.socket, count: int) -> list[dict]:
    return [json.loads(plotter.recv(65536), parse_constant=pytest.fail) for _ in range(count)]


def test_each_sample_is_one_object_in_one_datagram(plotter: socket.socket) -> None:
    out = JsonUdp(address(plotter), ("roll", "pitch"))
    out.send(rows([0.5, 1.5], 1_700_000_000.25))
    first, second = heard(plotter, 2)
    assert first["timestamp"] == 1_699_999_999.25
    assert second["timestamp"] == 1_700_000_000.25
    assert [first["device_time_s"], second["device_time_s"]] == [0.5, 1.5]
    assert [first["mismatch"], second["mismatch"]] == [0, 1]
    assert set(first) == {"timestamp", "device_time_s", "mismatch", "roll", "pitch"}
    assert first["roll"]["device_deg"] == pytest.approx(np.degrees(0.05))
    assert first["pitch"]["model_deg"] == pytest.approx(np.degrees(0.1 - 0.001))
    assert first["pitch"]["residual_deg"] == pytest.approx(np.degrees(0.001))
    assert (out.state().sent, out.state().dropped) == (2, 0)
    out.close()


def test_time_is_as_even_as_the_device_s_and_never_goes_back_by_jitter(plotter) -> None:
    out = JsonUdp(address(plotter), ("roll",))
    out.send(rows([0.0, 0.01], 100.010, axes=1))
    out.send(rows([0.02, 0.03], 100.080, axes=1))
    out.send(rows([0.04, 0.05], 100.051, axes=1))
    times = [sample["timestamp"] for sample in heard(plotter, 6)]
    np.testing.assert_allclose(np.diff(times), 0.01, atol=1e-6)
    out.close()


def test_a_restart_of_the_device_s_time_sets_it_anew(plotter) -> None:
    out = JsonUdp(address(plotter), ("roll",))
    out.send(rows([99.9], 500.0, axes=1))
    out.send(rows([0.1], 503.0, axes=1))
    assert [sample["timestamp"] for sample in heard(plotter, 2)] == [500.0, 503.0]
    out.close()


def test_what_is_no_number_is_left_out(plotter) -> None:
    out = JsonUdp(address(plotter), ("roll",))
    batch = rows([0.1], 1.0, axes=1)
    batch.model_rad[:] = np.nan
    batch.residual_rad[:] = np.inf
    out.send(batch)
    (sample,) = heard(plotter, 1)
    assert set(sample["roll"]) == {"device_deg"}
    out.close()


def test_nothing_is_sent_of_nothing_and_nobody_listening_is_counted(plotter) -> None:
    out = JsonUdp(address(plotter), ("roll",))
    out.send(rows([], 1.0, axes=1))
    assert out.state().sent == 0
    plotter.close()
    for i in range(50):
        out.send(rows([i / 100], 1.0 + i / 100, axes=1))
    counts = out.state()
    assert counts.sent + counts.dropped == 50
    assert counts.dropped > 0
    out.close()


def test_what_is_no_address_is_said() -> None:
    with pytest.raises(DeviceError, match="is not udp:HOST:PORT"):
        JsonUdp("127.0.0.1:9870", ("roll",))
