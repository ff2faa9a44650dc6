"""A whole FPGA system on a recording: sensor to link in GHDL, judged like an emulated board."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hostkit.emulation.board import BoardRun
from hostkit.emulation.comparison import EmulationResult, compare, compare_with_faults
from hostkit.emulation.fault import Fault
from hostkit.emulation.run import answer_of, heard_of, stimulus_of
from hostkit.emulation.system_bench import SystemRun, SystemTiming, run_system
from hostkit.emulation.system_faults import Generics, fault_generics
from hostkit.errors import EmulationError
from hostkit.filters import FILTERS
from hostkit.link.frames.decoder import Decoder
from hostkit.link.logs.tlog import TlogWriter
from hostkit.recordings import Recording
from hostkit.records import FilterDesign
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import Counts, to_counts
from hostkit.sensors.mpu6050 import TEMPERATURE_COUNTS_PER_DEG_C, TEMPERATURE_OFFSET_DEG_C
from hostkit.targets import Target

IntArray = NDArray[np.int64]

SHORTEST_US = 1250
"""Reading and checking the sensor takes 1.2 ms at most with the slow clock of the bench."""
SHORTEST_WITH_STATE_US = 1600
"""Two samples must take longer than one frame of a sample, one of a state, and a reading."""
US_PER_S = 1e6


def timing_of(design: FilterDesign) -> SystemTiming:
    """Return a timing in which a sample of a design takes few clocks."""
    tells_state = FILTERS[design.filter].lower(design).tells_state
    shortest_us = SHORTEST_WITH_STATE_US if tells_state else SHORTEST_US
    fitting = max(1, round(US_PER_S * design.period_s) // shortest_us)
    return SystemTiming(time_divisor=2 ** (fitting.bit_length() - 1))


def table_of(design: FilterDesign, recording: Recording, samples: int) -> tuple[Counts, IntArray]:
    """Return the counts of the first rows of a recording, and with their temperature as a table."""
    stimulus = stimulus_of(design, recording)
    counts = to_counts(
        SENSORS[design.sensor.part],
        design.sensor,
        recording.angular_rate_rad_s[:samples],
        recording.specific_force_m_s2[:samples],
    )
    above = stimulus.temperature_deg_c[:samples] - TEMPERATURE_OFFSET_DEG_C
    temperature = np.clip(np.rint(above * TEMPERATURE_COUNTS_PER_DEG_C), -(2**15), 2**15 - 1)
    rows = np.column_stack([counts.accel, counts.gyro, temperature.astype(np.int64)])
    return counts, rows


def emulate_system(
    folder: Path,
    target: Target,
    design: FilterDesign,
    recording: Recording,
    *,
    samples: int,
    faults: tuple[Fault, ...] = (),
    record: Path | None = None,
) -> EmulationResult:
    """Play the first rows of a recording through the system of a folder and compare.

    Parameters
    ----------
    folder
        Folder on which `build_system` has been called.
    samples
        So many rows at most.
    faults
        What is to go wrong on the model of the sensor meanwhile.
    record
        Where the frames go as a tlog, if anywhere.

    Raises
    ------
    EmulationError
        If the simulation fails or runs another design, or the model has no such fault.
    """
    timing = timing_of(design)
    counts, table = table_of(design, recording, samples)
    generics: Generics = ()
    if faults:
        generics = fault_generics(faults, design, timing, _first_us(folder, table, timing))
    run = run_system(folder, table, timing, generics)
    if record is not None:
        write_tlog(run, record)
    board = BoardRun(stream=run.stream)
    if not faults:
        return compare(target, design, counts, answer_of(board, target, design))
    frames, trace = heard_of(board, target, design)
    heard = frames, replace(trace, time_us=trace.time_us * timing.time_divisor)
    return compare_with_faults(target, design, counts, board, heard, faults, None)


def _first_us(folder: Path, table: IntArray, timing: SystemTiming) -> int:
    """Return when the first row is sampled if nothing goes wrong."""
    frames = Decoder().feed(run_system(folder, table[:3], timing).stream)
    times = [frame.message.time_usec for frame in frames if frame.name == "TILT_SAMPLE"]
    if not times:
        raise EmulationError("the simulated system sent no sample")
    return int(times[0])


def write_tlog(run: SystemRun, path: Path) -> None:
    """Write the frames of a run to a tlog, each with the time at which it had come whole.

    Raises
    ------
    HostkitError
        If the file cannot be written.
    """
    decoder, writer = Decoder(), TlogWriter(path)
    for byte, time_us in zip(run.stream, run.time_us.tolist(), strict=True):
        for frame in decoder.feed(bytes([byte])):
            writer.write(time_us, frame.raw)
    writer.close()
