"""Parameters over restarts, power cuts and floods, with the host firmware."""

from dataclasses import replace
from pathlib import Path

import pytest
from boards import Collector, changed, copied, generated, hear, stimulus
from designs import design
from ground import ACCEPTED, FAILED, IN_PROGRESS, Ground, acks, resting, texts, values

from hostkit.emulation import host_board

STORE = 245
READ, WRITE, RESET = 0, 1, 2
SLOT_BYTES = 128
ERASED = b"\xff" * 2 * SLOT_BYTES
GENERATION = slice(8, 10)


def kept(folder: Path, store: bytes, name: str = "FILT_TAU") -> float:
    """Return what a start with that store uses."""
    ground = Ground()
    ground.read(0.5, name)
    return values(ground.run(folder, stimulus(100), store=store))[-1][1]


def test_a_parameter_is_stored_when_it_was_quiet_for_a_while(host_folder: Path) -> None:
    ground = Ground()
    ground.set(1.0, "FILT_TAU", 1.5)
    soon = ground.board_run(host_folder, resting(300))
    assert soon.store == ERASED
    later = ground.board_run(host_folder, resting(500))
    assert later.store != ERASED
    used = values(hear(later))[-1][1]
    assert kept(host_folder, later.store) == used
    assert kept(host_folder, soon.store) != used


def test_a_flood_of_settings_is_written_once(host_folder: Path) -> None:
    ground = Ground()
    for i in range(300):
        ground.set(1.0 + 0.02 * i, "FILT_TAU", 1.0 + 0.01 * i)
    run = ground.board_run(host_folder, resting(1200))
    heard = hear(run)
    assert len(values(heard)) == 300
    assert [s.sequence for s in heard.samples] == list(range(1200))
    assert run.store[:SLOT_BYTES] == ERASED[:SLOT_BYTES]
    assert run.store[SLOT_BYTES:][GENERATION] == b"\x01\x00", "the first record of all"
    assert kept(host_folder, run.store) == values(heard)[-1][1]


def test_there_and_back_is_not_written_at_all(host_folder: Path) -> None:
    first = Ground()
    first.set(0.5, "FILT_TAU", 1.5)
    stored = first.board_run(host_folder, resting(500)).store
    second = Ground()
    second.set(0.5, "FILT_TAU", 3.0)
    second.set(0.7, "FILT_TAU", 1.5)
    assert second.board_run(host_folder, resting(500), store=stored).store == stored


def test_storing_on_command_is_answered_when_it_is_done(host_folder: Path) -> None:
    ground = Ground()
    ground.set(1.0, "FILT_TAU", 1.5)
    ground.command(1.1, STORE, WRITE)
    run = ground.board_run(host_folder, resting(250))
    assert acks(hear(run)) == [(STORE, IN_PROGRESS), (STORE, ACCEPTED)]
    assert kept(host_folder, run.store) == values(hear(run))[-1][1]


def test_reading_goes_back_to_what_is_stored(host_folder: Path) -> None:
    ground = Ground()
    ground.command(0.5, STORE, READ)  # nothing is
    ground.set(1.0, "FILT_TAU", 1.5)
    ground.command(1.1, STORE, WRITE)
    ground.set(2.0, "FILT_TAU", 3.0)
    ground.command(2.1, STORE, READ)
    heard = ground.run(host_folder, resting(300))
    assert acks(heard)[0] == (STORE, FAILED)
    told = [value for name, value in values(heard) if name == "FILT_TAU"]
    assert told == [pytest.approx(v, rel=1e-3) for v in (1.5, 3.0, 1.5)]


def test_resetting_goes_back_to_the_design_and_stays(host_folder: Path) -> None:
    ground = Ground()
    ground.set(1.0, "FILT_TAU", 1.5)
    ground.set(1.1, "SYS_ID", 9)
    ground.command(1.2, STORE, WRITE)
    ground.command(2.0, STORE, RESET)
    run = ground.board_run(host_folder, resting(700))
    heard = hear(run)
    assert (STORE, ACCEPTED) in acks(heard)
    assert dict(values(heard))["SYS_ID"] == 1.0
    assert not heard.samples[-1].flags & 4
    assert any(s.flags & 4 for s in heard.samples)
    assert kept(host_folder, run.store) == pytest.approx(2.847, rel=1e-3)


def test_what_is_set_just_before_a_reboot_is_not_lost(host_folder: Path) -> None:
    ground = Ground()
    ground.set(1.0, "FILT_TAU", 1.5)
    ground.command(1.1, 246, 1)
    ground.read(2.5, "FILT_TAU")
    run = ground.board_run(host_folder, resting(400))
    assert dict(run.faults)["resets"] == 1
    told = [value for _, value in values(hear(run))]
    assert told[0] == told[-1] == pytest.approx(1.5, rel=1e-3)


def test_a_store_of_another_design_is_ignored(host_folder: Path, tmp_path: Path) -> None:
    other = design(eta=0.98)
    folder = generated("host", tmp_path / "code", other)
    host_board.build(folder)
    ground = Ground()
    ground.set(0.5, "FILT_TAU", 1.5)
    store = ground.board_run(host_folder, resting(500)).store
    assert kept(folder, store) == pytest.approx(0.01 * 0.98 / 0.02, rel=1e-3)


@pytest.mark.parametrize("after", [0, 1, 9, 11, 20, 39, 40, 41])
def test_a_power_cut_while_storing_loses_at_most_the_change(host_folder: Path, after: int) -> None:
    first = Ground()
    first.set(0.5, "FILT_TAU", 1.5)
    stored = first.board_run(host_folder, resting(500)).store
    old = kept(host_folder, stored)
    second = Ground()
    second.set(0.5, "FILT_TAU", 4.0)
    second.read(6.0, "FILT_TAU")
    run = second.board_run(host_folder, resting(800), store=stored, power_cut_after=after)
    heard = hear(run)
    new, found = values(heard)[0][1], values(heard)[-1][1]
    assert dict(run.faults)["resets"] == 1
    assert [s.sequence for s in heard.samples].count(0) == 2
    assert found == old, "no byte of the new record was its last"
    assert new != old


def test_a_memory_that_loses_bytes_is_reported_and_not_tried_for_ever(
    host_folder: Path, tmp_path: Path
) -> None:
    folder = copied(host_folder, tmp_path / "code")
    changed(folder / "hk_host_store.c", "    change(place, byte);", "    (void)byte;")
    host_board.build(folder, sanitize=True)
    ground = Ground()
    ground.set(0.5, "FILT_TAU", 1.5)
    ground.command(0.6, STORE, WRITE)
    heard = ground.run(folder, resting(900))
    assert acks(heard) == [(STORE, IN_PROGRESS), (STORE, FAILED)]
    assert texts(heard) == ["Parameters cannot be stored"]


def test_the_file_holds_each_byte_at_once(host_folder: Path, tmp_path: Path) -> None:
    """A program that is killed leaves what a memory would hold."""
    run = Ground().board_run(host_folder, resting(50))
    assert run.store == ERASED
    short = Ground().board_run(host_folder, resting(50), store=b"\x00\x01\x02")
    assert short.store == b"\x00\x01\x02" + ERASED[3:]


def test_a_served_board_listens(host_folder: Path) -> None:
    ground = Ground()
    waiting = [ground.frame(message) for message in questions()]
    collector = Collector(lambda data: len(hear(data).of("PARAM_VALUE")) >= 7)

    def receive() -> bytes:
        heard = len(hear(collector.data).samples)
        return waiting.pop(0) if heard > 10 and waiting else b""

    host_board.serve(
        host_folder, replace(stimulus(20), loop=True), collector.send, collector.stop, receive
    )
    heard = hear(collector.data)
    assert len(values(heard)) >= 7
    assert len(heard.of("PING")) == 1


def questions() -> list:
    from ground import M

    return [M.MAVLink_ping_message(1, 2, 0, 0), M.MAVLink_param_request_list_message(1, 1)]


def test_a_firmware_that_hangs_is_restarted_by_the_watchdog(
    host_folder: Path, tmp_path: Path
) -> None:
    folder = copied(host_folder, tmp_path / "code")
    changed(
        folder / "hk_app.c",
        "    hk_hal_watchdog_feed();\n",
        "    if (app->samples != 50U || hk_hal_reset_cause() == HK_RESET_WATCHDOG) {\n"
        "        hk_hal_watchdog_feed();\n    }\n"
        "    if (app->samples == 50U && hk_hal_reset_cause() != HK_RESET_WATCHDOG) {\n"
        "        return true;\n    }\n",
    )
    host_board.build(folder, sanitize=True)
    run = host_board.run(folder, replace(resting(400)))
    heard = hear(run)
    assert dict(run.faults)["resets"] == 1
    assert texts(heard) == ["Restarted by the watchdog"]
    assert [s.sequence for s in heard.samples].count(0) == 2
    assert heard.samples[-1].sequence > 100
