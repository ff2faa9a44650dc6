"""The whole FPGA system: from the bus of a simulated sensor to the bytes of the serial line."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from cocotb_run import run_bench
from designs import all_parameters, design
from recorded import swept

from hostkit.cli.main import run
from hostkit.design_file import digest, save_design
from hostkit.emulation.comparison import EmulationResult
from hostkit.emulation.fault import parse_fault
from hostkit.emulation.fpga_system import emulate_system, table_of, timing_of, write_tlog
from hostkit.emulation.system_bench import IntArray, SystemRun, build_system, run_system
from hostkit.errors import BuildError, EmulationError
from hostkit.filters.complementary import lower, parameters, run_integer, step_integer
from hostkit.link.frames.decoder import Decoder, Frame, trace_of
from hostkit.link.logs.tlog import read_tlog
from hostkit.recordings import save
from hostkit.records import AXES, FilterDesign
from hostkit.render import FpgaOptions, generate, write
from hostkit.render.registers import register_map
from hostkit.targets import TARGETS

RATE_HZ = 25.0
DESIGN = design(rate_hz=RATE_HZ, accel_full_scale_g=4)
TARGET = TARGETS["spartan3adsp"]
BENCHES = Path(__file__).parent / "benches"
BOOT, ACTIVE, CRITICAL = 1, 4, 5
RESTARTED, SATURATED, RETUNED = 1, 2, 4

pytestmark = pytest.mark.usefixtures("ghdl_installed")


def build(built: FilterDesign, folder: Path) -> Path:
    write(generate(built, TARGET), folder)
    build_system(folder)
    return folder


@pytest.fixture(scope="module")
def system(tmp_path_factory: pytest.TempPathFactory, ghdl_installed: None) -> Path:
    return build(DESIGN, tmp_path_factory.mktemp("system"))


def frames_of(run: SystemRun) -> list[Frame]:
    return Decoder().feed(run.stream)


def samples_of(frames: list[Frame]) -> list:
    return [frame.message for frame in frames if frame.name == "TILT_SAMPLE"]


def states_of(frames: list[Frame]) -> list[int]:
    return [f.message.system_status for f in frames if f.name == "HEARTBEAT"]


def play(system: Path, table: IntArray, **generics: object) -> SystemRun:
    pairs = tuple((name, str(value)) for name, value in generics.items())
    return run_system(system, table, timing_of(DESIGN), pairs)


# --- Without faults


@pytest.fixture(scope="module")
def judged(system: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, int]:
    """Return a folder with a design, a recording and the frames of a run, and its exit code."""
    folder = tmp_path_factory.mktemp("judged")
    save_design(DESIGN, folder / "design.json")
    save(swept(DESIGN), folder / "sweep.csv")
    command = ["emulate", str(folder / "design.json"), "--target", TARGET.name, "--system"]
    command += ["--recording", str(folder / "sweep.csv"), "--code", str(system)]
    command += ["--samples", "60", "--record", str(folder / "frames.tlog")]
    return folder, run(command)


def test_every_sample_equals_the_integer_model(judged: tuple[Path, int]) -> None:
    folder, code = judged
    assert code == 0
    frames = Decoder().feed(b"".join(read_tlog(folder / "frames.tlog")))
    samples = samples_of(frames)
    assert [message.sequence for message in samples] == list(range(60))
    assert {bytes(message.digest).hex() for message in samples} == {digest(DESIGN)}
    assert [message.flags for message in samples] == [RESTARTED] + [0] * 59
    assert {message.i2c_errors for message in samples} == {0}
    # The first sample may have been found after a look at the registers, not announced.
    assert set(np.diff([message.time_usec for message in samples[1:]])) == {1250}
    states = states_of(frames)
    assert states[:2] == [BOOT, ACTIVE]
    assert set(states[2:]) == {ACTIVE}
    assert len(states) >= 4
    assert [frame.message.get_seq() for frame in frames] == list(range(len(frames)))


def monitored(folder: Path, design_file: str, tlog: str, capsys) -> tuple[int, dict]:
    capsys.readouterr()
    port = f"file:{folder / tlog}"
    code = run(["monitor", str(folder / design_file), "--port", port, "--json"])
    return code, json.loads(capsys.readouterr().out)


def test_the_monitor_judges_its_frames(judged: tuple[Path, int], capsys) -> None:
    folder, _ = judged
    code, said = monitored(folder, "design.json", "frames.tlog", capsys)
    assert (code, said["verdict"], said["samples"]) == (0, "pass", 60)

    save_design(replace(DESIGN, parameters=parameters(0.9)), folder / "other.json")
    code, said = monitored(folder, "other.json", "frames.tlog", capsys)
    assert (code, said["verdict"]) == (3, "refused")


def test_the_monitor_counts_a_spoilt_frame(judged: tuple[Path, int], capsys) -> None:
    folder, _ = judged
    raw = bytearray((folder / "frames.tlog").read_bytes())
    raw[len(raw) // 2] ^= 0x10
    (folder / "spoilt.tlog").write_bytes(raw)
    _, said = monitored(folder, "design.json", "spoilt.tlog", capsys)
    assert said["bad"] >= 1
    assert 50 <= said["samples"] < 60


def test_biases_are_sent_as_hidden_state(tmp_path: Path) -> None:
    built = all_parameters(rate_hz=RATE_HZ, tilt="arcsin", mounting="-y-x-z")
    folder = build(built, tmp_path)
    result = emulate_system(folder, TARGET, built, swept(built), samples=10)
    assert (result.samples, result.missing, result.mismatches) == (10, 0, 0)


def test_a_count_at_the_end_of_its_range_is_told(system: Path) -> None:
    table = np.zeros((8, 7), dtype=np.int64)
    table[:, 2] = 8192
    table[:, 6] = np.arange(8)
    for row, (axis, count) in enumerate([(0, 32767), (5, -32768), (3, -32767), (1, 32766)], 2):
        table[row, axis] = count
    frames = frames_of(play(system, table))
    assert [m.flags & SATURATED for m in samples_of(frames)] == [0, 0, 2, 2, 2, 0, 0, 0]
    require_model(frames, table)


def require_model(frames: list[Frame], table: IntArray) -> None:
    """Hold samples against the model that is fed with them alone."""
    trace = trace_of(frames, AXES[DESIGN.axes])
    rows = table[trace.sequence]
    np.testing.assert_array_equal(np.hstack([trace.accel_count, trace.gyro_count]), rows[:, :6])
    wanted = run_integer(lower(DESIGN), trace.accel_count, trace.gyro_count)
    np.testing.assert_array_equal(trace.state_raw, wanted)


def test_a_link_that_is_too_slow_loses_whole_samples(system: Path) -> None:
    _, table = table_of(DESIGN, swept(DESIGN), 12)
    timing = replace(timing_of(DESIGN), baud=200_000)
    frames = frames_of(run_system(system, table, timing, (("DRAIN_US", "6000"),)))
    sent = [message.sequence for message in samples_of(frames)]
    assert 4 <= len(sent) < 10
    assert sent == sorted(set(sent))
    require_model(frames, table)


# --- With faults


def with_fault(system: Path, text: str) -> EmulationResult:
    recording = swept(DESIGN)
    faults = (parse_fault(text),)
    return emulate_system(system, TARGET, DESIGN, recording, samples=14, faults=faults)


@pytest.mark.parametrize(
    ("fault", "missing", "errors", "restarts"),
    [
        ("nack-address=2@0.2", 1, {2}, 0),
        ("stuck-sda=9@0.2", 1, {1}, 0),
        ("clock-stretch=100@0.2", 0, {0}, 0),
        ("torn-burst@0.2", 1, {1}, 0),
        ("self-reset@0.2", 2, {0, 1}, 1),  # the sensor may be addressed while it resets
    ],
)
def test_the_system_recovers(
    system: Path, fault: str, missing: int, errors: set[int], restarts: int
) -> None:
    result = with_fault(system, fault)
    report = result.fault_report
    assert report.recovered
    assert result.passed
    assert result.missing <= missing
    assert report.errors in errors
    assert report.restarts == restarts


def test_a_refused_sensor_is_critical(system: Path) -> None:
    _, table = table_of(DESIGN, swept(DESIGN), 2)
    frames = frames_of(play(system, table, IDENTITY=0x12, LIMIT_US=20_000))
    assert samples_of(frames) == []
    assert states_of(frames)[:2] == [BOOT, CRITICAL]


def test_a_fault_the_model_lacks_is_refused(system: Path) -> None:
    with pytest.raises(EmulationError, match="no fault fifo-overflow"):
        with_fault(system, "fifo-overflow")


# --- With a bus


def test_settings_change_over_axi(tmp_path: Path) -> None:
    write(generate(DESIGN, TARGET, FpgaOptions(bus="axi4lite")), tmp_path / "code")
    _, table = table_of(DESIGN, swept(DESIGN), 40)
    counts = tmp_path / "counts.txt"
    lines = (" ".join(f"{word:04x}" for word in row) for row in table & 0xFFFF)
    counts.write_text("".join(line + "\n" for line in lines), encoding="ascii")
    spec, timing = lower(DESIGN), timing_of(DESIGN)
    tuned = replace(
        spec,
        blend=replace(spec.blend, raw=spec.blend.raw // 2),
        tilt_offset_raw=(1_000_000, -2_000_000),
    )
    places = {r.name: r.address for r in register_map(DESIGN, spec).registers}
    chosen = {
        "addresses": places,
        "baud": timing.baud,
        "clock_hz": timing.clock_hz,
        "start_us": 60_000,
        "heard": str(tmp_path / "heard.bin"),
        "settings": {
            "BLEND": tuned.blend.raw,
            "TILT_OFFSET_ROLL": tuned.tilt_offset_raw[0],
            "TILT_OFFSET_PITCH": tuned.tilt_offset_raw[1],
        },
    }
    run_bench(
        tmp_path / "code",
        "hk_system_axi",
        "system_axi_bench",
        build=tmp_path / "build",
        parameters={
            "COUNTS_FILE": str(counts),
            "CLOCK_HZ": timing.clock_hz,
            "BAUD": timing.baud,
            "TIME_DIVISOR": timing.time_divisor,
        },
        more_sources=[BENCHES / "hk_system_axi.vhd"],
        environment={"SYSTEM_BENCH": json.dumps(chosen)},
    )
    frames = Decoder().feed((tmp_path / "heard.bin").read_bytes())
    flags = [message.flags for message in samples_of(frames)]
    first = flags.index(RETUNED)
    assert first >= 3
    assert all(flag & RETUNED for flag in flags[first:])
    assert flags.count(RETUNED | RESTARTED) == 1
    trace = trace_of(frames, AXES[DESIGN.axes])
    for i, flag in enumerate(flags):
        used = tuned if flag & RETUNED else spec
        accel, gyro = trace.accel_count[i : i + 1], trace.gyro_count[i : i + 1]
        if flag & RESTARTED:
            wanted = run_integer(used, accel, gyro)
        else:
            wanted = step_integer(used, trace.state_raw[i - 1 : i], accel, gyro)
        np.testing.assert_array_equal(trace.state_raw[i : i + 1], wanted)


def test_a_wishbone_master_reads_identity_and_bytes(tmp_path: Path) -> None:
    write(generate(DESIGN, TARGET, FpgaOptions(bus="wishbone")), tmp_path / "code")
    run_bench(
        tmp_path / "code",
        "hk_system",
        "system_wishbone_bench",
        build=tmp_path / "build",
        parameters={"CLOCK_HZ": 4_000_000, "BAUD": 1_000_000},
    )


# --- Host side


def test_a_folder_without_a_system_is_refused(tmp_path: Path) -> None:
    with pytest.raises(BuildError, match="holds no hk_system_tb"):
        build_system(tmp_path)


def test_frames_of_a_run_become_a_tlog(tmp_path: Path, system: Path) -> None:
    _, table = table_of(DESIGN, swept(DESIGN), 2)
    heard = play(system, table)
    write_tlog(heard, tmp_path / "run.tlog")
    assert b"".join(read_tlog(tmp_path / "run.tlog")) == heard.stream


@pytest.mark.parametrize(
    ("more", "said"),
    [(["--samples", "9"], "--samples is of use with --system only"), (["--system"], "is no FPGA")],
)
def test_options_that_do_not_fit_are_refused(tmp_path: Path, capsys, more, said) -> None:
    save_design(DESIGN, tmp_path / "design.json")
    save(swept(DESIGN), tmp_path / "sweep.csv")
    command = ["emulate", str(tmp_path / "design.json"), "--target", "host"]
    assert run([*command, "--recording", str(tmp_path / "sweep.csv"), *more]) == 2
    assert said in capsys.readouterr().err
