"""The store by itself: whatever the supply does, a start finds the old record or the new one."""

from pathlib import Path

import pytest
from bench import CUT, FAILED, SAVED, SLOT_BYTES, Bench
from designs import design

OLD, MIDDLE, NEW = 7.0, 11.0, 42.0
SYS_ID = 0


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Bench:
    return Bench(tmp_path_factory.mktemp("bench"))


def test_an_erased_store_holds_no_record(bench: Bench) -> None:
    bench.erase()
    assert bench.load(SYS_ID) is None


@pytest.mark.parametrize("byte", [0x00, 0x55])
def test_a_memory_of_one_byte_over_and_over_holds_no_record(bench: Bench, byte: int) -> None:
    bench.erase()
    bench.memory[:] = byte
    assert bench.load(SYS_ID) is None


def test_what_is_saved_is_found_and_the_slots_take_turns(bench: Bench) -> None:
    bench.erase()
    for value in (OLD, MIDDLE, NEW):
        before = bench.memory.copy()
        assert bench.save(SYS_ID, value) == SAVED
        assert bench.load(SYS_ID) == value
        changed = (before != bench.memory).nonzero()[0] // SLOT_BYTES
        assert len(set(changed)) == 1


def test_what_is_there_already_is_not_written_again(bench: Bench) -> None:
    bench.erase()
    assert bench.save(SYS_ID, OLD) == SAVED
    written = bench.supplied.written
    assert bench.save(SYS_ID, OLD) == SAVED
    assert bench.supplied.written == written


@pytest.mark.parametrize("erases", [False, True], ids=["eeprom", "flash"])
@pytest.mark.parametrize("saved", [1, 2, 3])
@pytest.mark.parametrize("generation", [None, 0xFFFC, 0xFFFE, 0x00FE, 0x7FFF])
def test_a_supply_that_fails_leaves_the_old_record_or_the_new_one(
    bench: Bench, erases: bool, saved: int, generation: int | None
) -> None:
    bench.erase()
    for value in (OLD - 2, OLD - 1, OLD)[-saved:]:
        assert bench.save(SYS_ID, value) == SAVED
    if generation is not None:
        newest = 1 if saved % 2 else 0
        bench.make_generation(newest, generation)
        if saved > 1:
            bench.make_generation(1 - newest, generation - 1)
    assert bench.load(SYS_ID) == OLD
    before = bench.memory.copy()
    seen = set()
    for left in range(bench.c.HK_STORE_BYTES):
        for spoilt in (0x00, 0xFF, 0x01, 0x80, 0x55, int(before[left]), left & 0xFF):
            bench.memory[:] = before
            bench.supply(left, spoilt, erases=erases)
            assert bench.save(SYS_ID, NEW) == CUT
            bench.supply()
            found = bench.load(SYS_ID)
            assert found in (OLD, NEW), f"cut after {left} bytes, the next is {spoilt:#x}: {found}"
            seen.add(found)
            assert bench.save(SYS_ID, MIDDLE) == SAVED
            assert bench.load(SYS_ID) == MIDDLE
    assert OLD in seen


def test_every_value_of_the_spoilt_byte(bench: Bench) -> None:
    bench.erase()
    for value in (OLD - 1, OLD):
        bench.save(SYS_ID, value)
    before = bench.memory.copy()
    for left in range(0, bench.c.HK_STORE_BYTES):
        for spoilt in range(256):
            bench.memory[:] = before
            bench.supply(left, spoilt)
            bench.save(SYS_ID, NEW)
            bench.supply()
            assert bench.load(SYS_ID) in (OLD, NEW)


def test_two_failures_one_after_the_other(bench: Bench) -> None:
    """The second record is written over what is left of the first attempt."""
    bench.erase()
    for value in (OLD - 1, OLD):
        bench.save(SYS_ID, value)
    before = bench.memory.copy()
    for first in range(bench.c.HK_STORE_BYTES):
        bench.memory[:] = before
        bench.supply(first, 0xA5)
        bench.save(SYS_ID, NEW)
        between = bench.memory.copy()
        for second in range(bench.c.HK_STORE_BYTES):
            bench.memory[:] = between
            bench.supply(second, 0x3C)
            bench.save(SYS_ID, MIDDLE)
            bench.supply()
            assert bench.load(SYS_ID) in (OLD, NEW, MIDDLE)


def test_the_generation_goes_round(bench: Bench) -> None:
    bench.erase()
    bench.save(SYS_ID, OLD)
    bench.make_generation(1, 0xFFFE)
    for value in (MIDDLE, NEW, OLD):
        assert bench.save(SYS_ID, value) == SAVED
        assert bench.load(SYS_ID) == value
    assert bench.memory[8] == 2  # 0xFFFE, 0, 1, 2: 0xFFFF is what an erased slot shows
    assert bench.memory[SLOT_BYTES + 8] == 1


def test_a_record_whose_end_is_of_another_generation_is_none(bench: Bench) -> None:
    """Its checksum may be right all the same: one interrupted record of 65536 is so lucky."""
    bench.erase()
    for value in (OLD, NEW):
        bench.save(SYS_ID, value)
    bench.make_generation(0, 7)
    assert bench.load(SYS_ID) == NEW
    bench.make_generation(0, 7, end=6)
    assert bench.load(SYS_ID) == OLD


def test_a_flipped_bit_is_noticed_and_the_record_before_counts(bench: Bench) -> None:
    bench.erase()
    for value in (OLD, NEW):
        bench.save(SYS_ID, value)
    before = bench.memory.copy()
    for bit in range(8 * bench.c.HK_STORE_BYTES):
        bench.memory[:] = before
        bench.memory[bit // 8] ^= 1 << (bit % 8)
        assert bench.load(SYS_ID) == OLD


def test_a_memory_that_does_not_take_what_is_written_is_reported(bench: Bench) -> None:
    bench.erase()
    bench.save(SYS_ID, OLD)
    bench.supply(broken=True)
    assert bench.save(SYS_ID, NEW) == FAILED
    bench.supply()
    assert bench.load(SYS_ID) == OLD


@pytest.mark.parametrize("left", [0, 5, 20, 40])
def test_after_a_failure_the_good_slot_is_still_left_alone(bench: Bench, left: int) -> None:
    bench.erase()
    bench.save(SYS_ID, OLD)
    running = bench.started()
    bench.supply(broken=True)
    assert bench.save_to(*running, SYS_ID, MIDDLE) == FAILED
    bench.supply(left)
    assert bench.save_to(*running, SYS_ID, NEW) == CUT
    bench.supply()
    assert bench.load(SYS_ID) == OLD


def test_the_record_of_another_design_is_ignored(bench: Bench, tmp_path: Path) -> None:
    other = Bench(tmp_path, design(eta=0.98))
    bench.erase()
    bench.save(SYS_ID, OLD)
    other.memory[:] = bench.memory
    assert other.load(SYS_ID) is None
    assert other.save(SYS_ID, NEW) == SAVED
    assert other.load(SYS_ID) == NEW


def test_all_values_are_kept(bench: Bench) -> None:
    bench.erase()
    tau = bench.place("FILT_TAU")
    offset = bench.place("TILT_OFS_PITCH")
    bench.save(tau, 1.5)
    bench.save(offset, -0.02)
    assert bench.load(tau) == bench.set("FILT_TAU", 1.5)[1]
    assert bench.load(offset) == bench.set("TILT_OFS_PITCH", -0.02)[1]
