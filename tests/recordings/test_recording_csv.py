from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hostkit.errors import RecordingError
from hostkit.recordings import Recording, load, save
from hostkit.recordings.csv_file import parse_csv, render_csv

HEADER = "time_s,gyro_x_rad_s,gyro_y_rad_s,gyro_z_rad_s,accel_x_m_s2,accel_y_m_s2,accel_z_m_s2"
ROWS = ("0.00,0,0,0,0,0,9.81", "0.01,0.1,0,0,0,0,9.80", "0.02,0,0,0,0,0.1,9.81")


def written(folder: Path, *lines: str) -> Path:
    path = folder / "recording.csv"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def test_round_trip_is_exact(tmp_path: Path, full: Recording) -> None:
    save(full, tmp_path / "a.csv")
    back = load(tmp_path / "a.csv")
    for field in ("time_s", "angular_rate_rad_s", "specific_force_m_s2", "mag_ut"):
        assert getattr(back, field).tobytes() == getattr(full, field).tobytes(), field
    np.testing.assert_array_equal(back.temperature_deg_c, full.temperature_deg_c)
    np.testing.assert_array_equal(back.valid, full.valid)
    assert back.up_reference is not None
    np.testing.assert_allclose(back.up_reference, full.up_reference, atol=1e-15)
    assert (back.rate_hz, back.sensor, back.origin, back.licence) == (
        full.rate_hz,
        full.sensor,
        full.origin,
        full.licence,
    )


def test_every_float64_comes_back_to_the_last_bit(full: Recording) -> None:
    table = parse_csv(render_csv(full).encode())
    assert table.angular_rate_rad_s.tobytes() == full.angular_rate_rad_s.tobytes()


def test_name_and_digest(tmp_path: Path) -> None:
    recording = load(written(tmp_path, HEADER, *ROWS))
    assert recording.name == "recording"
    assert len(recording.sha256) == 64
    assert recording.rate_hz == 100.0
    assert recording.valid.all()
    assert recording.up_reference is None


def test_columns_in_any_order_beside_others(tmp_path: Path) -> None:
    path = written(
        tmp_path,
        "# sensor: mine",
        "label,accel_z_m_s2,accel_y_m_s2,accel_x_m_s2,gyro_z_rad_s,gyro_y_rad_s,gyro_x_rad_s,time_us",
        "walk,9.8,2,1,6,5,4,0",
        "",
        "stand still,9.8,2,1,6,5,4,10000",
        "# a remark",
        "walk,9.8,2,1,6,5,4,20000",
    )
    recording = load(path)
    assert recording.sensor == "mine"
    np.testing.assert_array_equal(recording.time_s, (0.0, 0.01, 0.02))
    np.testing.assert_array_equal(recording.angular_rate_rad_s[0], (4, 5, 6))
    np.testing.assert_array_equal(recording.specific_force_m_s2[0], (1, 2, 9.8))


def test_quaternion_reference_and_empty_cells(tmp_path: Path) -> None:
    half = np.sqrt(0.5)
    path = written(
        tmp_path,
        HEADER + ",ref_qw,ref_qx,ref_qy,ref_qz,temp_c",
        ROWS[0] + f",{half},{half},0,0,25",
        ROWS[1] + ",,,,,",
        ROWS[2] + ",nan,nan,nan,nan,26",
    )
    recording = load(path)
    assert recording.up_reference is not None
    np.testing.assert_allclose(recording.up_reference[0], (0, 1, 0), atol=1e-15)
    assert np.isnan(recording.up_reference[1:]).all()
    assert recording.temperature_deg_c is not None
    assert np.isnan(recording.temperature_deg_c[1])


def test_spreadsheet_marks_and_line_ends(tmp_path: Path) -> None:
    path = tmp_path / "a.CSV"
    quoted = ",".join(f'"{name}"' for name in HEADER.split(","))
    path.write_bytes(("\ufeff" + "\r\n".join((quoted, *ROWS))).encode())
    assert len(load(path)) == 3


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ((), "it is empty"),
        (("# only: remarks",), "it is empty"),
        ((HEADER,), r"0 sample\(s\)"),
        ((HEADER, ROWS[0]), r"1 sample\(s\); a recording needs at least 2"),
        ((HEADER.replace(",", ";"), ROWS[0]), "columns are separated by commas"),
        ((HEADER, ROWS[0], "0.01,0,0,x,0,0,9.8"), "line 3, column gyro_z_rad_s: 'x' is not a num"),
        ((HEADER, ROWS[0], "0.01,0,0,,0,0,9.8"), "line 3, column gyro_z_rad_s: '' is not a numb"),
        ((HEADER, ROWS[0], "0.01,0,0,1_0,0,0,9.8"), "'1_0' is not a number"),
        ((HEADER, "# note", ROWS[0], "0.01,0,0"), "line 4 has 3 cells; the header has 7"),
        ((HEADER, ROWS[0], ROWS[1] + ",1"), "line 3 has 8 cells; the header has 7"),
        ((HEADER, ROWS[0], ROWS[1].replace("0.1", "nan"), ROWS[2]), "row 2: angular rate x is nan"),
        ((HEADER, ROWS[0], ROWS[1].replace("9.80", "inf"), ROWS[2]), "row 2: specific force z is"),
        ((HEADER, ROWS[0], ROWS[2], ROWS[1]), r"row 3: time 0\.010000 s is before"),
        ((HEADER, ROWS[0], ROWS[1], ROWS[1]), "row 3: time .* repeats the time of the row before"),
        ((HEADER + ",time_us", ROWS[0] + ",0", ROWS[1] + ",1"), "time_s and time_us; keep one"),
        ((HEADER + ",time_s", ROWS[0] + ",0", ROWS[1] + ",1"), "time_s stand twice"),
        ((HEADER + ",mag_x_ut", ROWS[0] + ",0", ROWS[1] + ",1"), "lacks .* mag_y_ut, mag_z_ut"),
        ((HEADER + ",ref_roll_rad", ROWS[0] + ",0", ROWS[1] + ",1"), "lacks .* ref_pitch_rad"),
        ((HEADER + ",valid", ROWS[0] + ",1", ROWS[1] + ",2"), "row 2: valid = 2; it must be 0 or"),
        (("# rate_hz: fast", HEADER, *ROWS), "'rate_hz: fast' is not a number"),
        (("# rate_hz: nan", HEADER, *ROWS), "rate_hz = nan; it must be a rate above 0"),
        ((HEADER, ROWS[0], '"0.01,0,0,0,0,0,9.8'), "line 3 "),
    ],
)
def test_faults_are_named(tmp_path: Path, lines: tuple[str, ...], message: str) -> None:
    with pytest.raises(RecordingError, match=message) as caught:
        load(written(tmp_path, *lines))
    assert str(caught.value).startswith(str(tmp_path / "recording.csv"))


@pytest.mark.parametrize(
    ("ours", "theirs", "hint"),
    [
        ("gyro_x_rad_s", "gyro_x_deg_s", r"gyro_x_deg_s is in deg/s: multiply by pi/180"),
        ("gyro_z_rad_s", "GyroZ_dps", r"GyroZ_dps is in deg/s: .* call it gyro_z_rad_s"),
        (
            "accel_y_m_s2",
            "accel_y_g",
            r"accel_y_g is in g: multiply by 9\.80665 and call",
        ),
        ("accel_z_m_s2", "acc_z_mg", r"acc_z_mg is in mg: .* call it accel_z_m_s2"),
        ("accel_x_m_s2", "accel_x_raw", r"accel_x_raw is in counts"),
        ("time_s", "timestamp_ms", r"timestamp_ms is in ms: divide by 1000 and call it time_s"),
        ("time_s", "t_us", r"t_us is in us: divide by 1e6 and call it time_s"),
        ("accel_x_m_s2", "accel_x_ms2", r"is accel_x_ms2 meant to be accel_x_m_s2"),
    ],
)
def test_missing_column_suggests_what_is_like_it(
    tmp_path: Path, ours: str, theirs: str, hint: str
) -> None:
    with pytest.raises(RecordingError, match=hint) as caught:
        load(written(tmp_path, HEADER.replace(ours, theirs), *ROWS))
    assert f"lacks the column(s) {ours};" in str(caught.value)
    assert f"it has {HEADER.replace(ours, theirs).replace(',', ', ')};" in str(caught.value)


def test_text_that_is_not_utf8(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_bytes(b"time_s,\xff\xfe\n")
    with pytest.raises(RecordingError, match="byte 7 is not UTF-8"):
        load(path)


def test_missing_file_and_unknown_suffix(tmp_path: Path, full: Recording) -> None:
    with pytest.raises(RecordingError, match=r"none\.csv cannot be read: No such file"):
        load(tmp_path / "none.csv")
    with pytest.raises(RecordingError, match=r"ends in \.xlsx; recordings end in \.csv or \.npz"):
        load(tmp_path / "a.xlsx")
    with pytest.raises(RecordingError, match="ends in no suffix"):
        save(full, tmp_path / "a")


@settings(max_examples=300, deadline=None)
@given(st.binary(max_size=200))
def test_no_bytes_make_anything_but_a_recording_error(content: bytes) -> None:
    for start in (b"", HEADER.encode() + b"\n" + ROWS[0].encode() + b"\n"):
        try:
            parse_csv(start + content)
        except RecordingError:
            continue
