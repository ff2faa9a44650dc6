"""The device side: models, decoder, emulated targets, simulated core."""

import statistics
import tempfile
from collections.abc import Iterator
from pathlib import Path

from benchmarks.device_cost import cost_table
from benchmarks.problems import SENSOR, steps
from benchmarks.table import MISSING, Table
from benchmarks.timing import ratio, seconds
from hostkit.dialect import python_module
from hostkit.emulation import avr_board, ghdl, host_board
from hostkit.emulation.run import stimulus_of
from hostkit.errors import ToolMissingError
from hostkit.filters.complementary import lower, parameters, run_float, run_integer
from hostkit.link.frames.decoder import Decoder
from hostkit.mounting import Mounting
from hostkit.records import FilterDesign
from hostkit.render import generate, write
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import to_counts, to_rate_and_force_g
from hostkit.targets import TARGETS

RATE_HZ, SAMPLES = 100.0, 6000
FRAMES, CHUNK_BYTES = 5000, 256
RECORDING = steps(SAMPLES, RATE_HZ)
DESIGN = FilterDesign(
    filter="complementary",
    axes="both",
    tilt="atan2",
    mounting=Mounting(),
    rate_hz=RATE_HZ,
    sensor=SENSOR,
    parameters=parameters(0.97),
)
Row = tuple[str, str, str]


def tables() -> Iterator[Table]:
    """Measure the device side."""
    rows = (*models(), *decoder(), *emulation("host"), *emulation("atmega328p"), *core())
    yield Table(
        title=f"Models, link and targets: two axes, atan2, {RECORDING.duration_s:g} s at "
        f"{RATE_HZ:g} Hz",
        columns=("figure", "value", "remark"),
        rows=rows,
    )
    yield cost_table(DESIGN)


def models() -> Iterator[Row]:
    """Hold the integer model against the float model, both in Python."""
    part, spec = SENSORS["mpu6050"], lower(DESIGN)
    counts = to_counts(part, SENSOR, RECORDING.angular_rate_rad_s, RECORDING.specific_force_m_s2)
    exact = to_rate_and_force_g(part, SENSOR, counts)
    value = ratio(
        lambda: run_integer(spec, counts.accel, counts.gyro), lambda: run_float(DESIGN, *exact)
    )
    yield "models: integer / float, time", f"{value:.1f}", "Python, whole recording"


def decoder() -> Iterator[Row]:
    """Hold our counting decoder against pymavlink's own parser."""
    module, stream = python_module(), _frames()
    chunks = [stream[i : i + CHUNK_BYTES] for i in range(0, len(stream), CHUNK_BYTES)]

    def ours() -> None:
        one = Decoder()
        assert sum(len(one.feed(chunk)) for chunk in chunks) == FRAMES

    def peer() -> None:
        parser = module.MAVLink(None)
        assert sum(len(parser.parse_buffer(chunk) or ()) for chunk in chunks) == FRAMES

    yield "decoder: ours / pymavlink's parser, time", f"{ratio(ours, peer):.2f}", "with accounting"


def _frames() -> bytes:
    module = python_module()
    sender = module.MAVLink(None, 1, 1)
    frames = []
    for k in range(FRAMES):
        message = module.MAVLink_tilt_sample_message(
            k, k, k, k, [1, 2, 3], [4, 5, 6], 7, 0, [0] * 6, 0
        )
        frames.append(bytes(message.pack(sender)))
        sender.seq = (sender.seq + 1) % 256
    return b"".join(frames)


def emulation(name: str) -> Iterator[Row]:
    """Measure the time to emulate a recording over its own length."""
    board = {"host": host_board, "atmega328p": avr_board}[name]
    with tempfile.TemporaryDirectory() as text:
        folder = Path(text)
        write(generate(DESIGN, TARGETS[name]), folder)
        try:
            size = board.build(folder)
            stimulus = stimulus_of(DESIGN, RECORDING)
            spent = statistics.median(
                seconds(lambda: board.run(folder, stimulus)) for _ in range(3)
            )
            run = board.run(folder, stimulus)
        except ToolMissingError as error:
            yield f"emulate {name}", MISSING, str(error)
            return
    yield f"emulate {name}: time / real time", f"{spent / RECORDING.duration_s:.3f}", ""
    if run.cycles_mean is not None:
        yield f"{name}: cycles per update, mean", f"{run.cycles_mean:.0f}", ""
        yield f"{name}: cycles per update, max", f"{run.cycles_max:.0f}", ""
        yield f"{name}: flash, bytes", f"{size.flash_bytes}", "whole image"
        yield f"{name}: static RAM, bytes", f"{size.ram_bytes}", "whole image"


def core() -> Iterator[Row]:
    """Measure the latency of the core, and simulation time over real time."""
    part = SENSORS["mpu6050"]
    counts = to_counts(part, SENSOR, RECORDING.angular_rate_rad_s, RECORDING.specific_force_m_s2)
    with tempfile.TemporaryDirectory() as text:
        folder = Path(text)
        write(generate(DESIGN, TARGETS["spartan3adsp"]), folder)
        try:
            ghdl.analyse(folder)
            runs = []
            spent = seconds(lambda: runs.append(ghdl.simulate(folder, counts.accel, counts.gyro)))
        except ToolMissingError as error:
            yield "simulate spartan3adsp", MISSING, str(error)
            return
    yield "simulate spartan3adsp: time / real time", f"{spent / RECORDING.duration_s:.3f}", ""
    yield "spartan3adsp: latency, clocks", f"{runs[0].latency_cycles.max()}", ""
