"""The validator beside the real firmware, whose parameters change while it runs."""

import math
from pathlib import Path

import pytest
from boards import generated, require_or_skip, stimulus
from designs import all_parameters, design
from ground import Ground
from judging import feed

from hostkit.emulation import host_board
from hostkit.emulation.comparison import FLOAT_TOLERANCE_RAD
from hostkit.link.frames.decoder import Decoder
from hostkit.records import FilterDesign, ValidationReport
from hostkit.render import FirmwareOptions, generate, write
from hostkit.targets import TARGETS
from hostkit.validation import Thresholds, Validator

SAMPLES = 400
FREE = Thresholds(max_rms_deg=0.05)
"""Wild motion at full scale is as far from the float model as the bound of the design allows."""


@pytest.fixture(scope="module")
def host_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    require_or_skip("gcc", "make")
    folder = generated("host", tmp_path_factory.mktemp("host"))
    host_board.build(folder)
    return folder


def judged(
    ground: Ground, folder: Path, code: FilterDesign, *, start: int = 0, **options: object
) -> ValidationReport:
    run = ground.board_run(folder, stimulus(SAMPLES, code))
    frames = [frame.raw for frame in Decoder().feed(run.stream)]
    validator = Validator(code, **options)
    feed(validator, Decoder(), frames[start:], code)
    return validator.report(FREE)


def test_every_change_of_the_firmware_is_followed_to_the_bit(host_folder: Path) -> None:
    ground = Ground()
    ground.set(0.8, "FILT_TAU", 0.5)
    ground.set(1.3, "GYRO_BIAS_ROLL", 0.1)
    ground.set(1.8, "TILT_OFS_PITCH", -0.2)
    ground.set(2.3, "FILT_TAU", -7.0)
    ground.command(2.8, 245, 2.0)
    ground.set(3.3, "TILT_OFS_ROLL", 0.3)
    report = judged(ground, host_folder, design())
    assert (report.verdict, report.reasons) == ("pass", ())
    assert (report.checked, report.mismatches, report.unjudged) == (SAMPLES, 0, 0)
    assert [p.name for p in report.retuned] == ["TILT_OFS_ROLL"]


def test_a_new_bias_of_a_design_with_an_integral_is_followed(tmp_path: Path) -> None:
    code = all_parameters()
    folder = generated("host", tmp_path / "code", code)
    host_board.build(folder)
    ground = Ground()
    ground.set(1.0, "GYRO_BIAS_ROLL", 0.1)
    ground.set(1.7, "FILT_TAU", 0.2)
    ground.set(2.5, "GYRO_BIAS_PITCH", -0.05)
    report = judged(ground, folder, code)
    assert (report.checked, report.mismatches, report.unjudged) == (SAMPLES, 0, 0)
    assert report.verdict == "pass"


def test_a_listener_who_comes_late_judges_from_the_list_on(host_folder: Path) -> None:
    ground = Ground()
    ground.set(0.8, "FILT_TAU", 0.5)
    ground.list(1.6)
    report = judged(ground, host_folder, design(), start=200)
    assert (report.verdict, report.mismatches, report.untold) == ("pass", 0, ())
    assert 10 < report.unjudged < 150
    assert [p.name for p in report.retuned] == ["FILT_TAU"]
    assert report.retuned[0].device_value == pytest.approx(0.5, rel=1e-4)
    assert report.rms_rad < math.radians(0.05)


@pytest.mark.parametrize("code", [design(), all_parameters()], ids=["eta", "all"])
def test_the_filter_in_float_is_within_its_tolerance(tmp_path: Path, code: FilterDesign) -> None:
    options = FirmwareOptions(arithmetic="float")
    write(generate(code, TARGETS["host"], options), tmp_path / "code")
    host_board.build(tmp_path / "code")
    ground = Ground()
    ground.list(0.6)
    ground.set(1.5, "FILT_TAU", 0.4)
    ground.set(2.2, "TILT_OFS_PITCH", 0.1)
    report = judged(ground, tmp_path / "code", code, tolerance_rad=FLOAT_TOLERANCE_RAD)
    assert (report.mismatches, report.unjudged, report.verdict) == (0, 0, "pass")
    assert report.checked == SAMPLES
    assert 0.0 < report.max_rad < FLOAT_TOLERANCE_RAD
    assert [p.name for p in report.retuned] == ["FILT_TAU", "TILT_OFS_PITCH"]
