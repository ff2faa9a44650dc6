"""Recordings that show little or nothing, and how long a diagnosis takes."""

import json
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from diagnosis_cases import Simulate, Still

from hostkit.diagnosis import Diagnosis, diagnose, findings, to_document
from hostkit.errors import RecordingError
from hostkit.recordings import Recording
from hostkit.records import AxisChoice

pytestmark = pytest.mark.filterwarnings("error")


def odd(still: Still) -> dict[str, Recording]:
    rng = np.random.default_rng(1)
    nan = np.full((500, 3), np.nan)
    in_part = np.tile((np.nan, 0.0, 1.0), (500, 1))
    late = np.where(np.arange(500)[:, None] < 300, nan, (0.0, 0.0, 1.0))
    return {
        "two samples": still(2),
        "three samples": still(3),
        "constant": still(5000),
        "none valid": still(500, valid=np.zeros(500, dtype=np.bool_)),
        "weightless": still(500, specific_force_m_s2=np.zeros((500, 3))),
        "reference lost": still(500, up_reference=nan),
        "reference in part": still(500, up_reference=in_part),
        "reference where invalid": still(500, up_reference=late, valid=np.arange(500) < 250),
        "temperature lost": still(500, temperature_deg_c=np.full(500, np.nan)),
        "upside down": still(500, specific_force_m_s2=np.tile((0.0, 0.0, -9.8), (500, 1))),
        "one sample a second": still(500, time_s=np.arange(500.0), rate_hz=1.0),
        "wild": still(
            3000,
            angular_rate_rad_s=30.0 * rng.standard_normal((3000, 3)),
            specific_force_m_s2=20.0 * rng.standard_normal((3000, 3)),
        ),
    }


CASES = (
    "two samples",
    "three samples",
    "constant",
    "none valid",
    "weightless",
    "reference lost",
    "reference in part",
    "reference where invalid",
    "temperature lost",
    "upside down",
    "one sample a second",
    "wild",
)


def document(diagnosis: Diagnosis) -> str:
    return json.dumps(to_document(((Path("odd.csv"), diagnosis),)), allow_nan=False)


@pytest.mark.parametrize("axes", ["both", "roll", "pitch"])
@pytest.mark.parametrize("case", CASES)
def test_odd_recordings_are_diagnosed_without_nan(
    still: Still, case: str, axes: AxisChoice
) -> None:
    diagnosis = diagnose(odd(still)[case], axes=axes, noise=True)
    assert "null" in document(diagnosis)
    assert "nan" not in " ".join(finding.line() for finding in findings(diagnosis))
    expected = "needs a three-dimensional filter" if case == "wild" else None
    assert diagnosis.planarity.verdict == expected


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"time_s": np.zeros(500)}, "repeats the time of the row before"),
        ({"rate_hz": float("nan")}, "it must be a rate above 0 Hz"),
        ({"rate_hz": -1.0}, "it must be a rate above 0 Hz"),
        ({"angular_rate_rad_s": np.full((500, 3), np.nan)}, "angular rate x is nan"),
        ({"specific_force_m_s2": np.full((500, 3), np.inf)}, "specific force x is inf"),
    ],
)
def test_what_cannot_be_diagnosed_is_refused(
    still: Still, change: dict[str, object], message: str
) -> None:
    with pytest.raises(RecordingError, match=message):
        diagnose(still(500, **change))


def test_a_diagnosis_is_quick(moved: Simulate) -> None:
    """Below 0.2 s of one core for 1e5 samples of free motion; twice that where cores are shared."""
    part = moved("free", 30.0)
    repeated = {
        name: np.tile(getattr(part, name), (34, 1))[:100_000]
        for name in ("angular_rate_rad_s", "specific_force_m_s2")
    }
    recording = replace(
        part,
        time_s=np.arange(100_000) / 100.0,
        valid=np.ones(100_000, dtype=np.bool_),
        up_reference=None,
        **repeated,
    )
    taken_s = []
    for _ in range(5):
        begin_s = time.process_time()
        diagnose(recording)
        taken_s.append(time.process_time() - begin_s)
    assert min(taken_s) < 0.4
