"""The observer on real recordings: all targets have the integer model's every bit.

Each piece holds rest that the filter finds, the start of a motion, and fast motion. Recordings of
100 Hz share a design with every parameter, so that a target is built twice only.
"""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from boards import TARGET_TOOLS, changed, require_or_skip

from hostkit.emulation.run import build, emulate
from hostkit.errors import BuildError
from hostkit.filters.observer import OBSERVER, default_parameters, parameter, parameters
from hostkit.mounting import Mounting
from hostkit.recordings import Recording, load
from hostkit.records import FilterDesign, Parameter, SensorConfig
from hostkit.render import FirmwareOptions, generate, write
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import to_counts
from hostkit.simulation import SensorErrors, simulate
from hostkit.targets import TARGETS
from hostkit.tuning import sensor_config

SENSOR = SensorConfig(
    part="mpu6050", gyro_full_scale_deg_s=1000, accel_full_scale_g=4, low_pass_setting=1
)
MOST_DEG = 0.01
BOARD_S, FPGA_S = 5.0, 4.0
"""Seconds of a piece that are played; the simulated core takes three times as long."""


@dataclass(frozen=True)
class Piece:
    """Where a piece of a recording begins, and a rate (deg/s) that its first seconds exceed."""

    recording: str
    begin_s: float
    exceeds_deg_s: float

    def of(self, data: Path, length_s: float) -> Recording:
        whole = load(data / f"{self.recording}.npz")
        begin, length = (round(t * whole.rate_hz) for t in (self.begin_s, length_s))
        rows = slice(begin, begin + length)
        return Recording(
            name=whole.name,
            time_s=whole.time_s[rows],
            rate_hz=whole.rate_hz,
            angular_rate_rad_s=whole.angular_rate_rad_s[rows],
            specific_force_m_s2=whole.specific_force_m_s2[rows],
            valid=whole.valid[rows],
        )


PIECES = {
    "of 143 Hz": (Piece("broad/08_undisturbed_fast_rotation_with_breaks_A", 27.4, 500.0),),
    "of 100 Hz": (
        Piece("repoimu_tstick/TStick_Test07_Trial3", 1.7, 80.0),
        Piece("repoimu_pendulum/Pendulum_Test02b_Trial1_Segment_3", 42.5, 200.0),
        Piece("robot_mpu/MPU6050RM3100_V_500_seq4", 0.0, 400.0),
        Piece("upenn_arduimu/set07", 3.2, 100.0),
    ),
}

EVERY: tuple[Parameter, ...] = (
    parameter("kb", 0.02),
    parameter("clip_rate", math.radians(400.0)),
    parameter("lead", 0.004),
    parameter("gyro_bias", 0.01, "x"),
    parameter("gyro_bias", -0.006, "z"),
    parameter("gyro_scale", 0.012, "y"),
    parameter("accel_offset", -0.15, "x"),
    parameter("accel_offset", 0.2, "z"),
    parameter("accel_scale", 0.008, "y"),
)


def design_of(recordings: tuple[Recording, ...], more: tuple[Parameter, ...]) -> FilterDesign:
    names = {p.name for p in more}
    kept = tuple(p for p in default_parameters() if p.name not in names)
    rate_hz = recordings[0].rate_hz
    return FilterDesign(
        filter="observer",
        axes="both",
        tilt="atan2",
        mounting=Mounting.parse("+z+x+y" if more else "+x+y+z"),
        rate_hz=rate_hz,
        sensor=sensor_config(recordings, rate_hz),
        parameters=parameters(*kept, *more),
    )


def pieces_of(data: Path, which: str, length_s: float) -> tuple[Recording, ...]:
    return tuple(piece.of(data, length_s) for piece in PIECES[which])


def design_for(data: Path, which: str) -> FilterDesign:
    return design_of(pieces_of(data, which, BOARD_S), EVERY if len(PIECES[which]) > 1 else ())


@pytest.mark.parametrize("which", PIECES)
def test_pieces_hold_rest_a_start_and_fast_motion(which: str, data_folder: Path) -> None:
    design = design_for(data_folder, which)
    spec = OBSERVER.lower(design)
    rested = [word.name for word in spec.hidden].index("rested") + len(spec.axes)
    for piece in PIECES[which]:
        recording = piece.of(data_folder, FPGA_S)
        rate = recording.angular_rate_rad_s
        counts = to_counts(
            SENSORS[design.sensor.part], design.sensor, rate, recording.specific_force_m_s2
        )
        found = OBSERVER.run_integer(spec, counts.accel, counts.gyro)[:, rested]
        assert (found[0], found[-1]) == (0, 1), piece
        assert np.degrees(np.abs(rate).max()) > piece.exceeds_deg_s, piece


@pytest.mark.parametrize("which", PIECES)
@pytest.mark.parametrize("name", TARGETS.names())
def test_every_target_agrees_bit_for_bit(
    name: str, which: str, data_folder: Path, tmp_path: Path
) -> None:
    require_or_skip(*TARGET_TOOLS[name])
    target, design = TARGETS[name], design_for(data_folder, which)
    write(generate(design, target), tmp_path)
    build(tmp_path, target)
    for recording in pieces_of(data_folder, which, FPGA_S if target.kind == "fpga" else BOARD_S):
        result = emulate(tmp_path, target, design, recording)
        assert (result.samples, result.missing) == (len(recording), 0), recording.name
        assert (result.mismatches, result.passed) == (0, True), recording.name
        assert math.degrees(result.max_abs_error_rad or math.inf) < MOST_DEG, recording.name
        if target.kind == "mcu":  # a core shows all words of each sample
            assert result.states_told == math.ceil(len(recording) / design.rate_hz)


def simulated_design() -> FilterDesign:
    return FilterDesign(
        filter="observer",
        axes="both",
        tilt="atan2",
        mounting=Mounting(),
        rate_hz=250.0,
        sensor=SENSOR,
        parameters=default_parameters(),
    )


def test_the_small_board_loses_none_of_250_samples_a_second(tmp_path: Path) -> None:
    """Each of them goes out over the link."""
    require_or_skip(*TARGET_TOOLS["atmega328p"])
    target = TARGETS["atmega328p"]
    recording = simulate(
        "free",
        duration_s=2.0,
        rate_hz=250.0,
        sensor=SENSOR,
        errors=SensorErrors(),
        rng=np.random.default_rng(1),
    )
    design = simulated_design()
    write(generate(design, target), tmp_path)
    build(tmp_path, target)
    result = emulate(tmp_path, target, design, recording)
    assert (result.samples, result.missing, result.mismatches) == (500, 0, 0)
    assert result.faults == ()
    assert result.cycles_max is not None
    assert result.cycles_max < 20_000


def test_what_does_not_fit_the_small_board_is_refused_with_what_does(tmp_path: Path) -> None:
    require_or_skip(*TARGET_TOOLS["atmega328p"])
    target = TARGETS["atmega328p"]
    options = FirmwareOptions(signing=True)
    write(generate(simulated_design(), target, options), tmp_path)
    what = r"atmega328p has 32256 .* fits: no --signing, or --target rp2040"
    with pytest.raises(BuildError, match=what):
        build(tmp_path, target)


@pytest.mark.parametrize(
    ("told", "instead"),
    [
        ("words[1] = filter->still;", "words[1] = filter->still + 1;"),
        ("filter->accel_mean, 3U", "filter->gyro_mean, 3U"),
    ],
    ids=["still", "accel_mean"],
)
def test_a_wrong_word_of_the_state_is_found(
    told: str, instead: str, data_folder: Path, tmp_path: Path
) -> None:
    """Words that no angle shows soon."""
    require_or_skip(*TARGET_TOOLS["host"])
    target, design = TARGETS["host"], design_for(data_folder, "of 100 Hz")
    write(generate(design, target), tmp_path)
    changed(tmp_path / "hk_filter.c", told, instead)
    build(tmp_path, target)
    recording = PIECES["of 100 Hz"][2].of(data_folder, 2.0)
    assert emulate(tmp_path, target, design, recording).mismatches == 2
