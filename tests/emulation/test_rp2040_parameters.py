"""The whole application on the RP2040: what a ground station sets is there at the next start."""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest
from boards import Heard, hear, stimulus

from hostkit.dialect import python_module
from hostkit.emulation import rp2040_board
from hostkit.emulation.board import BoardRun, LinkInput

SECTOR = 4096
NAME = "FILT_TAU"
RESTART, STORE = 246, 245
TAU_S = 1.5


class Station:
    """Packs what a ground station sends, to every system and component."""

    def __init__(self) -> None:
        self.module = python_module()
        self.mav = self.module.MAVLink(None, srcSystem=255, srcComponent=190)

    def pack(self, message: object) -> bytes:
        frame = bytes(message.pack(self.mav))
        self.mav.seq = (self.mav.seq + 1) % 256
        return frame

    def set(self, time_s: float, value: float) -> LinkInput:
        m = self.module
        message = m.MAVLink_param_set_message(0, 0, NAME.encode(), value, m.MAV_PARAM_TYPE_REAL32)
        return LinkInput(time_s=time_s, data=self.pack(message))

    def ask(self, time_s: float) -> LinkInput:
        message = self.module.MAVLink_param_request_read_message(0, 0, NAME.encode(), -1)
        return LinkInput(time_s=time_s, data=self.pack(message))

    def command(self, time_s: float, number: int) -> LinkInput:
        message = self.module.MAVLink_command_long_message(0, 0, number, 0, 1, 0, 0, 0, 0, 0, 0)
        return LinkInput(time_s=time_s, data=self.pack(message))


def run(folder: Path, *pieces: LinkInput, store: bytes = b"", cut: int | None = None) -> BoardRun:
    feels = replace(stimulus(250), received=pieces, store=store, power_cut_after=cut)
    return rp2040_board.run(folder, feels)


def values(heard: Heard) -> list[float]:
    return [m.param_value for m in heard.of("PARAM_VALUE") if m.param_id == NAME]


@pytest.fixture(scope="module")
def stored(pico_folder: Path) -> BoardRun:
    station = Station()
    return run(pico_folder, station.set(0.6, TAU_S), station.command(0.9, STORE))


def test_a_parameter_is_set_stored_and_there_at_the_next_start(
    pico_folder: Path, stored: BoardRun
) -> None:
    heard = hear(stored)
    assert values(heard) == [pytest.approx(TAU_S, rel=1e-3)]
    assert (STORE, 0) in [(m.command, m.result) for m in heard.of("COMMAND_ACK")]
    assert set(stored.store[SECTOR + 128 :]) | set(stored.store[128:SECTOR]) == {0xFF}
    assert {bytes(stored.store[i : i + 4]) == b"\xff" * 4 for i in (0, SECTOR)} == {True, False}
    again = hear(run(pico_folder, Station().ask(0.6), store=stored.store))
    assert values(again) == values(heard)
    assert values(hear(run(pico_folder, Station().ask(0.6)))) != values(heard)


@pytest.mark.parametrize("cut", [0, 1, 20, 40])
def test_a_supply_that_fails_leaves_the_old_value_or_the_new(
    pico_folder: Path, stored: BoardRun, cut: int
) -> None:
    station = Station()
    pieces = station.set(0.6, 3.0), station.command(0.9, STORE), station.ask(2.0)
    done = run(pico_folder, *pieces, store=stored.store, cut=cut)
    assert dict(done.faults)["resets"] == 1
    before, after = values(hear(done))
    assert before == pytest.approx(3.0, rel=1e-3)
    assert after == pytest.approx(TAU_S, rel=1e-3)
    assert done.store != stored.store


def test_a_restart_on_request_is_told_and_done(pico_folder: Path) -> None:
    done = run(pico_folder, Station().command(1.0, RESTART))
    heard = hear(done)
    assert dict(done.faults)["resets"] == 1
    assert [(m.command, m.result) for m in heard.of("COMMAND_ACK")] == [(RESTART, 0)]
    sequences = [sample.sequence for sample in heard.samples]
    assert sum(b != a + 1 for a, b in pairwise(sequences)) == 1
    assert sequences.count(0) == 2
