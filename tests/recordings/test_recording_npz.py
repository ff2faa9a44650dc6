import io
import zipfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hostkit.errors import RecordingError
from hostkit.recordings import Recording, load, save
from hostkit.recordings.npz_file import parse_npz

SAMPLES = 20
PLAIN: dict[str, object] = {
    "time_us": np.arange(SAMPLES, dtype=np.int32) * 10_000,
    "rate_hz": 100.0,
    "gyro_rad_s": np.full((SAMPLES, 3), 0.1, dtype=np.float32),
    "accel_m_s2": np.tile(np.float32((0, 0, 9.8)), (SAMPLES, 1)),
    "sensor": "mine",
}


def content(**changes: object) -> bytes:
    buffer = io.BytesIO()
    arrays = {key: value for key, value in (PLAIN | changes).items() if value is not None}
    np.savez_compressed(buffer, **arrays)  # type: ignore[arg-type]
    return buffer.getvalue()


def loaded(folder: Path, data: bytes) -> Recording:
    path = folder / "a.npz"
    path.write_bytes(data)
    return load(path)


def test_round_trip_is_exact(tmp_path: Path, full: Recording) -> None:
    save(full, tmp_path / "a.npz")
    back = load(tmp_path / "a.npz")
    for field in ("time_s", "angular_rate_rad_s", "specific_force_m_s2", "mag_ut", "valid"):
        assert getattr(back, field).tobytes() == getattr(full, field).tobytes(), field
    np.testing.assert_array_equal(back.temperature_deg_c, full.temperature_deg_c)
    assert back.up_reference is not None
    np.testing.assert_allclose(back.up_reference, full.up_reference, atol=1e-15)
    assert (back.sensor, back.origin, back.licence) == (full.sensor, full.origin, full.licence)


def test_same_recording_same_bytes(
    tmp_path: Path, full: Recording, monkeypatch: pytest.MonkeyPatch
) -> None:
    save(full, tmp_path / "a.npz")
    monkeypatch.setattr("time.time", lambda: 2e9)
    save(full, tmp_path / "b.npz")
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()


def test_small_types_become_float64(tmp_path: Path) -> None:
    recording = loaded(tmp_path, content())
    assert recording.time_s[1] == 0.01
    assert recording.angular_rate_rad_s.dtype == np.float64
    assert recording.sensor == "mine"
    assert recording.licence == ""
    assert recording.valid.all()


def test_references(tmp_path: Path) -> None:
    quaternion = np.tile((1.0, 0, 0, 0), (SAMPLES, 1))
    tilt = np.tile((0.5 * np.pi, 0.0), (SAMPLES, 1))
    level = loaded(tmp_path, content(ref_quat_wxyz=quaternion)).up_reference
    rolled = loaded(tmp_path, content(ref_tilt_rad=tilt)).up_reference
    np.testing.assert_allclose(level, np.tile((0.0, 0, 1), (SAMPLES, 1)), atol=1e-15)
    np.testing.assert_allclose(rolled, np.tile((0.0, 1, 0), (SAMPLES, 1)), atol=1e-15)
    with pytest.raises(RecordingError, match="reference twice"):
        loaded(tmp_path, content(ref_quat_wxyz=quaternion, ref_tilt_rad=tilt))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"gyro_rad_s": None}, r"lacks the array\(s\) gyro_rad_s; it has .*accel_m_s2"),
        ({"time_us": None}, r"lacks the array\(s\) time_s"),
        ({"accel_m_s2": np.zeros((SAMPLES, 2))}, r"accel_m_s2 has shape \(20, 2\); .* \(20, 3\)"),
        ({"gyro_rad_s": np.zeros((5, 3))}, r"gyro_rad_s has shape \(5, 3\)"),
        ({"time_us": np.zeros((SAMPLES, 1))}, r"time_us has shape \(20, 1\)"),
        ({"gyro_rad_s": np.full((SAMPLES, 3), "x")}, "not real numbers"),
        ({"gyro_rad_s": np.zeros((SAMPLES, 3), complex)}, "not real numbers"),
        ({"gyro_rad_s": np.full((SAMPLES, 3), None)}, "gyro_rad_s holds Python objects"),
        ({"sensor": np.array([{}])}, "sensor holds Python objects"),
        ({"sensor": np.zeros(3)}, "sensor holds float64 of shape .* not one text"),
        ({"rate_hz": np.zeros(3)}, r"rate_hz has shape \(3,\); it must be one number"),
        ({"rate_hz": 0.0}, "rate_hz = 0.0; it must be a rate above 0"),
        ({"time_us": np.zeros(1), "gyro_rad_s": np.zeros((1, 3)),
          "accel_m_s2": np.zeros((1, 3))}, r"1 sample\(s\)"),
        ({"valid": np.full(SAMPLES, 3)}, "row 1: valid = 3; it must be 0 or 1"),
        ({"time_us": np.full(SAMPLES, np.nan)}, "row 1: time_s is nan"),
    ],
)  # fmt: skip
def test_faults_are_named(tmp_path: Path, changes: dict[str, object], message: str) -> None:
    with pytest.raises(RecordingError, match=message):
        loaded(tmp_path, content(**changes))


def lying(shape: str) -> bytes:
    """An archive in which the header of one array claims another shape than is there."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive, zipfile.ZipFile(io.BytesIO(content())) as honest:
        for name in honest.namelist():
            data = honest.read(name)
            if name.startswith("gyro"):
                header = f"{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}".ljust(
                    117
                )
                data = data[:8] + (118).to_bytes(2, "little") + header.encode() + b"\n" + data[128:]
            archive.writestr(name, data)
    return buffer.getvalue()


@pytest.mark.parametrize("shape", ["(1000000000000, 3)", "(20, 4)", "(-1, 3)", "(1, 2, 3)"])
def test_header_that_claims_what_is_not_there(tmp_path: Path, shape: str) -> None:
    with pytest.raises(RecordingError, match="claims shape"):
        loaded(tmp_path, lying(shape))


@pytest.mark.parametrize("data", [b"", b"PK", b"time_s,gyro", b"\x93NUMPY\x01\x00v\x00{}"])
def test_what_is_no_archive(tmp_path: Path, data: bytes) -> None:
    with pytest.raises(RecordingError, match=r"not an \.npz file or is damaged"):
        loaded(tmp_path, data)


def test_truncated_archive(tmp_path: Path) -> None:
    whole = content()
    for length in range(0, len(whole), 97):
        with pytest.raises(RecordingError):
            loaded(tmp_path, whole[:length])


WHOLE = content()


@settings(max_examples=400, deadline=None)
@given(st.lists(st.tuples(st.integers(0, len(WHOLE) - 1), st.integers(0, 255)), max_size=6))
def test_no_damage_makes_anything_but_a_recording_error(changes: list[tuple[int, int]]) -> None:
    damaged = bytearray(WHOLE)
    for place, value in changes:
        damaged[place] = value
    try:
        parse_npz(bytes(damaged))
    except RecordingError:
        return
