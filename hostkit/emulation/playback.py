"""A stimulus as files and options for a board program, and its statistics as a record."""

import json
import struct
from dataclasses import dataclass
from pathlib import Path

from hostkit.emulation.board import BoardRun, LinkInput, Progress, Stimulus
from hostkit.errors import EmulationError

START_TIMEOUT_S = 60.0
SAMPLE_TIMEOUT_S = 0.1
"""Added for every sample; an emulated AVR at 100 Hz takes about a millisecond."""
FAULTS = ("unread_samples", "stalled", "struck", "resets")


@dataclass(frozen=True, slots=True, kw_only=True)
class Playback:
    """Where the files of a run are, and the options that say so."""

    table: Path
    statistics: Path
    store: Path
    options: tuple[str, ...]


def playback(stimulus: Stimulus, folder: Path) -> Playback:
    """Write the table of a stimulus to a folder and return the options that play it."""
    table, statistics = folder / "table.bin", folder / "statistics.json"
    store, received = folder / "store.bin", folder / "received.bin"
    table.write_bytes(stimulus.table())
    store.write_bytes(stimulus.store)
    received.write_bytes(b"".join(_packed(piece) for piece in stimulus.received))
    faults = stimulus.faults
    options = [
        *("--settle", str(stimulus.settle_samples)),
        *("--statistics", str(statistics)),
        *("--nack", str(faults.nack)),
        *("--hold-sda", str(faults.hold_sda_clocks)),
        *("--fault-row", str(faults.from_row)),
        *("--store", str(store)),
    ]
    if stimulus.received:
        options += ["--received", str(received)]
    if stimulus.power_cut_after is not None:
        options += ["--power-cut", str(stimulus.power_cut_after)]
    if faults.who_am_i is not None:
        options += ["--who-am-i", str(faults.who_am_i)]
    for fault in faults.planned:
        options += ["--fault", f"{fault.code}:{fault.row}:{fault.amount}"]
    if stimulus.loop:
        options.append("--realtime")
    return Playback(table=table, statistics=statistics, store=store, options=tuple(options))


def _packed(piece: LinkInput) -> bytes:
    """Return a little-endian float64, the time (s), a uint32, how many bytes, and the bytes."""
    return struct.pack("<dI", piece.time_s, len(piece.data)) + piece.data


def require_end(stimulus: Stimulus) -> None:
    """Refuse a stimulus that would never end.

    Raises
    ------
    EmulationError
        If it loops.
    """
    if stimulus.loop:
        raise EmulationError("a looping stimulus never ends; serve it instead of running it")


def run_timeout_s(stimulus: Stimulus) -> float:
    """Return how long the run of a stimulus may take on a slow host."""
    return START_TIMEOUT_S + SAMPLE_TIMEOUT_S * len(stimulus)


def board_run(play: Playback, heard: bytes, progress: Progress | None) -> BoardRun:
    """Read the statistics of a run that has ended.

    Raises
    ------
    EmulationError
        If the program left none.
    """
    try:
        found = json.loads(play.statistics.read_text(encoding="ascii"))
    except (OSError, ValueError) as error:
        raise EmulationError(f"the board left no statistics: {error}") from error
    if progress is not None:
        progress(int(found["rows_played"]))
    return BoardRun(
        stream=heard,
        cycles_mean=found.get("cycles_mean"),
        cycles_max=found.get("cycles_max"),
        stack_bytes=found.get("stack_bytes"),
        faults=tuple((name, int(found[name])) for name in FAULTS if found.get(name)),
        store=play.store.read_bytes(),
    )
