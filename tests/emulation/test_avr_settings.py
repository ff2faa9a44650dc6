"""The whole application on the ATmega328P: parameters over the link, kept in the EEPROM."""

from dataclasses import replace
from pathlib import Path

import pytest
from boards import BOOT, Heard, hear, stimulus

from hostkit.dialect import python_module
from hostkit.emulation import avr_board
from hostkit.emulation.board import BoardRun, LinkInput

MAVLINK = python_module()
NAME = b"FILT_TAU"
TAU_S = 2.0
SET_AT_S, SAVE_AT_S, ASK_AT_S = 0.6, 0.7, 2.2
GROUND_STATION = 255
ANYBODY = 0
SAMPLES = 220


def frame(message: object) -> bytes:
    sender = MAVLINK.MAVLink(None, srcSystem=GROUND_STATION, srcComponent=190)
    return bytes(message.pack(sender))


def setting() -> LinkInput:
    message = MAVLINK.MAVLink_param_set_message(
        ANYBODY, ANYBODY, NAME, TAU_S, MAVLINK.MAV_PARAM_TYPE_REAL32
    )
    return LinkInput(time_s=SET_AT_S, data=frame(message))


def asking() -> LinkInput:
    message = MAVLINK.MAVLink_param_request_read_message(ANYBODY, ANYBODY, NAME, -1)
    return LinkInput(time_s=ASK_AT_S, data=frame(message))


def command(at_s: float, number: int) -> LinkInput:
    message = MAVLINK.MAVLink_command_long_message(ANYBODY, ANYBODY, number, 0, 1, 0, 0, 0, 0, 0, 0)
    return LinkInput(time_s=at_s, data=frame(message))


def saving() -> LinkInput:
    return command(SAVE_AT_S, MAVLINK.MAV_CMD_PREFLIGHT_STORAGE)


def rebooting() -> LinkInput:
    return command(1.5, MAVLINK.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN)


def run(folder: Path, *received: LinkInput, **store: bytes | int) -> BoardRun:
    return avr_board.run(folder, replace(stimulus(SAMPLES), received=received, **store))


def told(heard: Heard) -> list[float]:
    return [m.param_value for m in heard.of("PARAM_VALUE") if m.param_id == NAME.decode()]


def resets(found: BoardRun) -> int:
    return dict(found.faults).get("resets", 0)


def test_a_parameter_that_is_set_is_there_in_the_next_run(avr_folder: Path) -> None:
    first = run(avr_folder, setting(), saving())
    assert told(hear(first)) == [pytest.approx(TAU_S, rel=1e-3)]
    assert first.store.strip(b"\xff") != b""
    second = run(avr_folder, asking(), store=first.store)
    assert told(hear(second)) == told(hear(first))
    assert second.store == first.store
    assert resets(first) == resets(second) == 0


def test_a_board_that_starts_over_on_request_keeps_its_parameters(avr_folder: Path) -> None:
    heard = hear(run(avr_folder, setting(), rebooting(), asking()))
    assert heard.states.count(BOOT) == 2
    assert told(heard) == [pytest.approx(TAU_S, rel=1e-3)] * 2


@pytest.mark.parametrize("after", [0, 30])
def test_after_a_power_cut_the_old_or_the_new_value_holds(avr_folder: Path, after: int) -> None:
    old = run(avr_folder, asking())
    assert resets(old) == 0
    found = run(avr_folder, setting(), saving(), asking(), power_cut_after=after)
    heard = hear(found)
    assert resets(found) == 1
    assert heard.states.count(BOOT) == 2
    assert told(heard)[-1] in (told(hear(old))[0], told(heard)[0])
    assert len(heard.samples) > SAMPLES / 2
    again = hear(run(avr_folder, setting(), saving(), asking(), store=found.store))
    assert told(again) == [pytest.approx(TAU_S, rel=1e-3)] * 2
