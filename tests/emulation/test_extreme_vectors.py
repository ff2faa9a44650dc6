"""Extreme counts through every target: corners, full-range noise, wraps, the gate, the limit."""

from pathlib import Path

import numpy as np
import pytest
from boards import TARGET_TOOLS, generated, require_or_skip
from samples import SAMPLES, Sample

from hostkit.emulation.run import build, emulate
from hostkit.recordings import Recording
from hostkit.records import FilterDesign
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import Counts, to_counts
from hostkit.targets import TARGETS

CORE_ROWS = 500
"""Of a core's vectors, the first: those of tests/golden go through it whole."""


def recording_of(design: FilterDesign, counts: np.ndarray) -> Recording:
    """A recording that the configured sensor turns into given counts, shape ``(N, 6)``."""
    part = SENSORS[design.sensor.part]
    force = counts[:, :3] * part.m_s2_per_count(design.sensor)
    rate = counts[:, 3:] * part.rad_s_per_count(design.sensor)
    return Recording(
        name="extremes",
        time_s=np.arange(len(counts)) / design.rate_hz,
        rate_hz=design.rate_hz,
        angular_rate_rad_s=rate,
        specific_force_m_s2=force,
        valid=np.ones(len(counts), dtype=np.bool_),
    )


@pytest.mark.parametrize("sample", SAMPLES, ids=str)
@pytest.mark.parametrize("target", TARGETS.names())
def test_extremes_come_back_as_the_integer_model_says(
    sample: Sample, target: str, tmp_path: Path
) -> None:
    require_or_skip(*TARGET_TOOLS[target])
    counts = sample.counts[:CORE_ROWS] if TARGETS[target].kind == "fpga" else sample.counts
    recording = recording_of(sample.design, counts)
    part = SENSORS[sample.design.sensor.part]
    reached: Counts = to_counts(
        part, sample.design.sensor, recording.angular_rate_rad_s, recording.specific_force_m_s2
    )
    np.testing.assert_array_equal(np.hstack([reached.accel, reached.gyro]), counts)
    folder = generated(target, tmp_path, sample.design)
    build(folder, TARGETS[target])
    result = emulate(folder, TARGETS[target], sample.design, recording)
    assert (result.samples, result.missing, result.mismatches) == (len(recording), 0, 0)
