"""The application on the emulated STM32F103: its link, its store, a supply that fails, resets."""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest
from boards import assert_every_row_once, hear, stimulus

from hostkit.dialect import python_module
from hostkit.emulation import stm32_board
from hostkit.emulation.board import LinkInput

PREFLIGHT_STORAGE, PREFLIGHT_REBOOT = 245, 246
ACCEPTED = 0
TAU_S = 1.25


def said_at(*messages: tuple[float, object]) -> tuple[LinkInput, ...]:
    mav = python_module().MAVLink(None, srcSystem=255, srcComponent=190)
    pieces = []
    for time_s, message in messages:
        pieces.append(LinkInput(time_s=time_s, data=bytes(message.pack(mav))))
        mav.seq = (mav.seq + 1) % 256
    return tuple(pieces)


def set_tau():
    return python_module().MAVLink_param_set_message(1, 1, b"FILT_TAU", TAU_S, 9)


def read_tau():
    return python_module().MAVLink_param_request_read_message(1, 1, b"FILT_TAU", -1)


def command(number: int, value: float):
    return python_module().MAVLink_command_long_message(1, 1, number, 0, value, *[0.0] * 6)


def tau_of(run) -> list[float]:
    return [m.param_value for m in hear(run).of("PARAM_VALUE") if m.param_id == "FILT_TAU"]


SAVES = said_at((1.0, set_tau()), (1.2, command(PREFLIGHT_STORAGE, 1.0)))


def test_a_value_is_set_stored_and_found_at_the_next_start(stm32_folder: Path) -> None:
    first = stm32_board.run(stm32_folder, replace(stimulus(300), received=SAVES))
    heard = hear(first)
    assert tau_of(first) == [pytest.approx(TAU_S, rel=1e-3)]
    assert [ack.result for ack in heard.of("COMMAND_ACK")][-1] == ACCEPTED
    assert len(set(first.store)) > 1
    again = stm32_board.run(
        stm32_folder,
        replace(stimulus(100), store=first.store, received=said_at((0.8, read_tau()))),
    )
    assert tau_of(again) == tau_of(first)
    assert again.store == first.store


def test_a_change_of_the_store_costs_samples_and_nothing_else(stm32_folder: Path) -> None:
    """The core stands still for 40 ms; the time stamps must go on."""
    feels = replace(stimulus(300), received=SAVES)
    run = stm32_board.run(stm32_folder, feels)
    heard = hear(run)
    times_us = [s.time_usec for s in heard.samples]
    gaps = [b - a for a, b in pairwise(times_us) if b - a > 15_000]
    assert 1 <= len(gaps) <= 2
    assert all(30_000 < gap <= 60_000 for gap in gaps)
    assert heard.decoder.bad == 0
    assert "resets" not in dict(run.faults)
    assert times_us[-1] - times_us[0] == pytest.approx(299 * 10_000, abs=5)


@pytest.mark.parametrize("cut_after", [0, 1, 7, 40])
def test_after_a_supply_that_fails_the_application_starts_with_what_is_whole(
    stm32_folder: Path, cut_after: int
) -> None:
    kept = stm32_board.run(stm32_folder, replace(stimulus(300), received=SAVES)).store
    asks = said_at(
        (1.0, python_module().MAVLink_param_set_message(1, 1, b"FILT_TAU", 0.5, 9)),
        (1.2, command(PREFLIGHT_STORAGE, 1.0)),
        (2.5, read_tau()),
    )
    feels = replace(stimulus(300), received=asks, store=kept, power_cut_after=cut_after)
    run = stm32_board.run(stm32_folder, feels)
    assert dict(run.faults)["resets"] == 1
    assert tau_of(run)[-1] == pytest.approx(TAU_S, rel=1e-3)
    sequences = [s.sequence for s in hear(run).samples]
    assert sequences.count(0) == 2


def test_a_reboot_on_request(stm32_folder: Path) -> None:
    asks = said_at((1.0, command(PREFLIGHT_REBOOT, 1.0)))
    run = stm32_board.run(stm32_folder, replace(stimulus(200), received=asks))
    sequences = [s.sequence for s in hear(run).samples]
    assert dict(run.faults)["resets"] == 1
    assert sequences.count(0) == 2


def test_without_anything_received_nothing_is_stored(stm32_folder: Path) -> None:
    feels = stimulus(50)
    run = stm32_board.run(stm32_folder, feels)
    assert_every_row_once(hear(run), feels)
    assert set(run.store) == {0xFF}
    assert len(run.store) == 2048
