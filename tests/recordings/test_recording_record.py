from dataclasses import replace

import numpy as np
import pytest

from hostkit.errors import RecordingError
from hostkit.recordings import Recording


def test_arrays_are_owned_read_only_float64(full: Recording) -> None:
    rate = np.ones((50, 3), dtype=np.float32)
    recording = replace(full, angular_rate_rad_s=rate)
    assert recording.angular_rate_rad_s.dtype == np.float64
    assert recording.valid.dtype == np.bool_
    with pytest.raises(ValueError, match="read-only"):
        recording.angular_rate_rad_s[0, 0] = 2.0
    rate[0, 0] = 5.0
    assert recording.angular_rate_rad_s[0, 0] == 1.0


@pytest.mark.parametrize(
    ("field", "shape"),
    [
        ("angular_rate_rad_s", (49, 3)),
        ("specific_force_m_s2", (50,)),
        ("valid", (51,)),
        ("up_reference", (50, 4)),
        ("mag_ut", (3, 50)),
        ("temperature_deg_c", (50, 1)),
    ],
)
def test_wrong_shape_names_the_field(full: Recording, field: str, shape: tuple[int, ...]) -> None:
    with pytest.raises(RecordingError, match=field):
        replace(full, **{field: np.zeros(shape)})


def test_one_sample_is_too_few() -> None:
    with pytest.raises(RecordingError, match=r"1 sample\(s\); it needs at least 2"):
        Recording(
            name="one",
            time_s=np.zeros(1),
            rate_hz=100.0,
            angular_rate_rad_s=np.zeros((1, 3)),
            specific_force_m_s2=np.zeros((1, 3)),
            valid=np.ones(1, dtype=np.bool_),
        )


def test_length_and_duration(full: Recording) -> None:
    assert len(full) == 50
    assert full.duration_s == pytest.approx(0.49, abs=1e-4)
