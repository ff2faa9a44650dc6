"""Fast sampling: no sample is lost, whatever share of them the link carries."""

from pathlib import Path

import numpy as np
import pytest
from boards import TARGET_TOOLS, require_or_skip
from designs import design

from hostkit.emulation.run import build, emulate
from hostkit.render import generate, write
from hostkit.render.options import FirmwareOptions, MessageRate
from hostkit.simulation import SensorErrors, simulate
from hostkit.targets import TARGETS

BAUD = 500_000
SECONDS = 4.0


@pytest.mark.parametrize("acquisition", ["burst", "fifo"])
@pytest.mark.parametrize(
    ("target", "rate_hz", "sample_hz"),
    [("atmega328p", 500.0, 100.0), ("rp2040", 1000.0, 100.0), ("stm32f103", 1000.0, 100.0)],
)
def test_every_sample_is_taken(
    target: str, rate_hz: float, sample_hz: float, acquisition: str, tmp_path: Path
) -> None:
    require_or_skip(*TARGET_TOOLS[target])
    code = design(rate_hz=rate_hz, low_pass_setting=1)
    options = FirmwareOptions(
        baud=BAUD,
        message_rates=(MessageRate(name="TILT_SAMPLE", rate_hz=sample_hz),),
        acquisition=acquisition,
    )
    recording = simulate(
        "sine-sweep",
        duration_s=SECONDS,
        rate_hz=rate_hz,
        sensor=code.sensor,
        errors=SensorErrors(),
        rng=np.random.default_rng(1),
    )
    write(generate(code, TARGETS[target], options), tmp_path)
    build(tmp_path, TARGETS[target])
    result = emulate(tmp_path, TARGETS[target], code, recording)
    assert (result.missing, result.mismatches, result.faults) == (0, 0, ())
    assert result.samples == pytest.approx(SECONDS * sample_hz, abs=1)
