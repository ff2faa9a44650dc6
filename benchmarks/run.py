"""Measures speed as ratios to a peer in the same run: ``make bench``.

Every figure is the median over repetitions in which the two contenders take turns, so that a change
of the machine's speed hits both.
"""

import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from scipy.optimize import minimize_scalar

from hostkit.dialect import python_module
from hostkit.emulation import avr_board, ghdl, host_board
from hostkit.emulation.run import stimulus_of
from hostkit.errors import ToolMissingError
from hostkit.filters.complementary import lower, parameters, run_float, run_integer
from hostkit.link.decoder import Decoder
from hostkit.mounting import Mounting
from hostkit.records import FilterDesign, SensorConfig
from hostkit.render import generate, write
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import to_counts, to_rate_and_force_g
from hostkit.simulation import SensorErrors, simulate
from hostkit.targets import TARGETS
from hostkit.tuning import TuningOptions, tune
from hostkit.tuning.objective import cost, prepare
from hostkit.tuning.tune import TAU_BOUNDS_S

REPETITIONS = 5
RATE_HZ = 100.0
SENSOR = SensorConfig(
    part="mpu6050", gyro_full_scale_deg_s=500, accel_full_scale_g=4, low_pass_setting=3
)
RECORDING = simulate(
    "steps",
    duration_s=60.0,
    rate_hz=RATE_HZ,
    sensor=SENSOR,
    errors=SensorErrors(vibration_m_s2=2.0),
    rng=np.random.default_rng(1),
)
DESIGN = FilterDesign(
    filter="complementary",
    axes="both",
    tilt="atan2",
    mounting=Mounting(),
    rate_hz=RATE_HZ,
    sensor=SENSOR,
    parameters=parameters(0.97),
)


def seconds(action: Callable[[], object]) -> float:
    begun = time.perf_counter()
    action()
    return time.perf_counter() - begun


def ratio(ours: Callable[[], object], peer: Callable[[], object]) -> float:
    """Median of the pairwise ratio of times, ours over the peer's."""
    ours(), peer()
    return statistics.median(seconds(ours) / seconds(peer) for _ in range(REPETITIONS))


def row(what: str, value: str, remark: str) -> None:
    print(f"{what:<46}{value:>12}   {remark}")


def bench_tuning() -> None:
    """QPSO against scipy's bounded Brent search on the same objective."""
    streams = prepare(
        (RECORDING,), axes="both", tilt="atan2", mounting=Mounting(), period_s=1 / RATE_HZ
    )

    def log_cost(log_tau: float) -> float:
        tau_s = np.exp(log_tau)
        return float(cost(streams, "rmse", np.array([tau_s / (tau_s + 1 / RATE_HZ)]))[0])

    def brent() -> object:
        return minimize_scalar(
            log_cost, bounds=np.log(TAU_BOUNDS_S), method="bounded", options={"xatol": 1e-6}
        )

    def qpso() -> object:
        return tune((RECORDING,), TuningOptions(sensor=SENSOR))

    peer, ours = brent(), tune((RECORDING,), TuningOptions(sensor=SENSOR))
    row("tune: QPSO / scipy bounded Brent, time", f"{ratio(qpso, brent):.1f}", "below 1 is faster")
    row(
        "tune: evaluations, QPSO and Brent",
        f"{ours.swarm.evaluations}/{peer.nfev}",
        "with one parameter no swarm is needed",
    )
    excess = ours.swarm.cost / peer.fun - 1.0
    row("tune: cost, QPSO over Brent", f"{excess:+.1e}", "relative; below 0 is better")


def bench_models() -> None:
    """The integer model against the float model, both in Python."""
    part, spec = SENSORS["mpu6050"], lower(DESIGN)
    counts = to_counts(part, SENSOR, RECORDING.angular_rate_rad_s, RECORDING.specific_force_m_s2)
    exact = to_rate_and_force_g(part, SENSOR, counts)
    value = ratio(
        lambda: run_integer(spec, counts.accel, counts.gyro), lambda: run_float(DESIGN, *exact)
    )
    row("models: integer / float, time", f"{value:.1f}", "Python, whole recording")


def bench_decoder() -> None:
    """Our counting decoder against pymavlink's own parser."""
    module = python_module()
    sender = module.MAVLink(None, 1, 1)
    frames = []
    for k in range(5000):
        message = module.MAVLink_tilt_sample_message(
            k, k, k, k, [1, 2, 3], [4, 5, 6], 7, 0, [0] * 6, 0
        )
        frames.append(bytes(message.pack(sender)))
        sender.seq = (sender.seq + 1) % 256
    stream = b"".join(frames)
    chunks = [stream[i : i + 256] for i in range(0, len(stream), 256)]

    def ours() -> None:
        decoder = Decoder()
        assert sum(len(decoder.feed(chunk)) for chunk in chunks) == len(frames)

    def peer() -> None:
        parser = module.MAVLink(None)
        assert sum(len(parser.parse_buffer(chunk) or ()) for chunk in chunks) == len(frames)

    row("decoder: ours / pymavlink's parser, time", f"{ratio(ours, peer):.2f}", "with accounting")


def bench_emulation() -> None:
    """Time to emulate a recording over its own length."""
    for name, board in (("host", host_board), ("atmega328p", avr_board)):
        with tempfile.TemporaryDirectory() as text:
            folder = Path(text)
            write(generate(DESIGN, TARGETS[name]), folder)
            try:
                size = board.build(folder)
                stimulus = stimulus_of(DESIGN, RECORDING)
                spent = statistics.median(
                    seconds(lambda f=folder, b=board, s=stimulus: b.run(f, s)) for _ in range(3)
                )
                run = board.run(folder, stimulus)
            except ToolMissingError as error:
                row(f"emulate {name}", "-", str(error))
                continue
        row(f"emulate {name}: time / real time", f"{spent / RECORDING.duration_s:.3f}", "60 s")
        if run.cycles_mean is not None:
            row(f"{name}: cycles per update, mean", f"{run.cycles_mean:.0f}", "two axes, atan2")
            row(f"{name}: cycles per update, max", f"{run.cycles_max:.0f}", "two axes, atan2")
            row(f"{name}: flash, bytes", f"{size.flash_bytes}", "whole image")
            row(f"{name}: static RAM, bytes", f"{size.ram_bytes}", "whole image")


def bench_ghdl() -> None:
    """Latency of the core, and simulation time over real time."""
    part = SENSORS["mpu6050"]
    counts = to_counts(part, SENSOR, RECORDING.angular_rate_rad_s, RECORDING.specific_force_m_s2)
    with tempfile.TemporaryDirectory() as text:
        folder = Path(text)
        write(generate(DESIGN, TARGETS["spartan3adsp"]), folder)
        try:
            ghdl.analyse(folder)
            begun = time.perf_counter()
            run = ghdl.simulate(folder, counts.accel, counts.gyro)
        except ToolMissingError as error:
            row("simulate spartan3adsp", "-", str(error))
            return
        spent = time.perf_counter() - begun
    row("simulate spartan3adsp: time / real time", f"{spent / RECORDING.duration_s:.3f}", "60 s")
    row("spartan3adsp: latency, clocks", f"{run.latency_cycles.max()}", "two axes, atan2")


def main() -> int:
    """Print the table."""
    row("figure", "value", "remark")
    for bench in (bench_tuning, bench_models, bench_decoder, bench_emulation, bench_ghdl):
        bench()
    return 0


if __name__ == "__main__":
    sys.exit(main())
