"""Parts of the benchmark of the monitor; the figures themselves are not asserted."""

import os
import time

import pytest

from benchmarks.live_device import Cost, cpu_seconds, memory_bytes, watch
from benchmarks.monitor import Sustained, wanted_seconds
from hostkit.errors import HostkitError


def test_how_long_is_chosen_in_the_environment() -> None:
    assert wanted_seconds("") == 60.0
    assert wanted_seconds("600") == 600.0
    for text in ("long", "nan", "4.9"):
        with pytest.raises(HostkitError, match="HOSTKIT_BENCH_SECONDS"):
            wanted_seconds(text)


def test_the_cost_of_a_process_is_read() -> None:
    before = cpu_seconds(os.getpid())
    while cpu_seconds(os.getpid()) - before < 0.05:
        sum(range(1000))
    grown = bytearray(64 << 20)
    assert memory_bytes(os.getpid()) > len(grown)
    begun = time.monotonic()
    cost = watch(os.getpid(), 0.2)
    assert time.monotonic() - begun >= 0.2
    assert 0.0 <= cost.cpu_share < 0.9
    with pytest.raises(HostkitError, match="/proc"):
        cpu_seconds(-1)


def test_a_contender_is_held_against_the_peer() -> None:
    cost = Cost(cpu_share=0.3, early_bytes=50_000_000, late_bytes=51_000_000)
    peer = Cost(cpu_share=0.15, early_bytes=1, late_bytes=1)
    row = Sustained(name="ours", messages=3000, lost=0, cost=cost).row(peer)
    assert row == ("ours", "3000", "0", "30", "2", "50", "51")
