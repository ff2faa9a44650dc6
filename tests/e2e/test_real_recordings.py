"""The main job on real recordings: a pendulum that swings about the sensor's z axis."""

import json
import math
from dataclasses import replace
from pathlib import Path

import pytest

from hostkit.cli.main import run
from hostkit.emulation.run import build, emulate
from hostkit.errors import ToolMissingError
from hostkit.filters.complementary import parameter, parameters
from hostkit.mounting import Mounting
from hostkit.recordings import Recording, load
from hostkit.records import FilterDesign
from hostkit.render import generate, write
from hostkit.targets import TARGETS
from hostkit.tuning import sensor_config

SWING = Mounting.parse("+z+x+y")
ANCHOR_DEG, ANCHOR_ALL_DEG = 2.1, 1.75
EMULATED = (
    "Pendulum_Test03_Trial1_Segment_3",
    "Pendulum_Test05_Trial2_Segment_1",
    "Pendulum_Test08_Trial3_Segment_3",
)


@pytest.fixture(scope="module")
def pendulum(data_folder: Path) -> list[Path]:
    return sorted((data_folder / "repoimu_pendulum").glob("*.npz"))


@pytest.fixture(scope="module")
def tuned(pendulum: list[Path]) -> FilterDesign:
    recordings = tuple(load(path) for path in pendulum if path.stem in EMULATED)
    return FilterDesign(
        filter="complementary",
        axes="roll",
        tilt="atan2",
        mounting=SWING,
        rate_hz=100.0,
        sensor=sensor_config(recordings, 100.0),
        parameters=parameters(0.9966),
    )


@pytest.fixture(scope="module")
def tuned_in_all(tuned: FilterDesign) -> FilterDesign:
    """The same with every parameter, near where they end up when all are tuned."""
    every = (
        parameter("gyro_bias", 0.002, "roll"),
        parameter("gyro_scale", -0.05, "roll"),
        parameter("tilt_offset", -0.0003, "roll"),
        parameter("gate", 0.2),
        parameter("integral_gain", 0.009),
    )
    return replace(tuned, parameters=parameters(0.9977, *every))


@pytest.mark.parametrize(
    ("free", "most_deg"), [("tau", ANCHOR_DEG), ("all", ANCHOR_ALL_DEG)], ids=["tau", "all"]
)
def test_tuned_on_one_half_the_other_half_meets_the_anchor(
    pendulum: list[Path],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    free: str,
    most_deg: float,
) -> None:
    design = str(tmp_path / "pendulum.json")
    half = len(pendulum) // 2
    training, held_out = map(str, pendulum[:half]), map(str, pendulum[half:])
    options = ("--axes", "roll", "--mounting", "+z+x+y", "--free", free, "--resamples", "0")
    assert run(["tune", *training, *options, "--no-held-out", "-o", design]) == 0
    capsys.readouterr()
    assert run(["evaluate", design, *held_out, "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["mean_rmse_deg"]["roll"] <= most_deg
    assert all(r["integer_vs_float_max_deg"] <= 0.005 for r in document["recordings"])


@pytest.mark.parametrize("name", EMULATED)
@pytest.mark.parametrize("target", TARGETS.names())
def test_every_target_agrees_bit_for_bit_on_real_recordings(
    target: str, name: str, pendulum: list[Path], tuned: FilterDesign, tmp_path: Path
) -> None:
    recording = load(next(path for path in pendulum if path.stem == name))
    check_target(target, tuned, recording, tmp_path)


@pytest.mark.parametrize("target", TARGETS.names())
def test_every_target_agrees_with_every_parameter(
    target: str, pendulum: list[Path], tuned_in_all: FilterDesign, tmp_path: Path
) -> None:
    recording = load(next(path for path in pendulum if path.stem == EMULATED[-1]))
    check_target(target, tuned_in_all, recording, tmp_path)


def check_target(name: str, design: FilterDesign, recording: Recording, folder: Path) -> None:
    target = TARGETS[name]
    write(generate(design, target), folder)
    try:
        build(folder, target)
        result = emulate(folder, target, design, recording)
    except ToolMissingError as error:
        pytest.skip(str(error))
    assert (result.samples, result.missing, result.mismatches) == (len(recording), 0, 0)
    assert result.max_abs_error_rad is not None
    assert math.degrees(result.max_abs_error_rad) <= 0.005
    if name not in ("host", "linux"):
        assert result.cycles_mean is not None
        assert 0 < result.cycles_mean <= result.cycles_max
