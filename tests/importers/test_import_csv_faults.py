from pathlib import Path

import numpy as np
import pytest
from foreign_logs import DEG, G, same, table
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from hostkit.errors import HostkitError, RecordingError
from hostkit.importers import ImportOptions, import_recording
from hostkit.recordings import Recording


def test_cut_off_last_line_is_left_out(tmp_path: Path, truth: Recording, bring) -> None:
    path = table(
        tmp_path / "log.csv",
        "t,ax,ay,az,gx,gy,gz",
        truth.time_s,
        truth.specific_force_m_s2,
        truth.angular_rate_rad_s,
    )
    path.write_text(path.read_text()[:-30])
    imported = bring(path)
    assert len(imported.recording) == len(truth) - 1
    assert any("is cut off" in said for said in imported.guessed)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("0.05,", "0.05,x,", r"line 7 has 8 cells"),
        ("\n0.05,", "\noops,", r"line 7, column 1 \(t\): 'oops' is not a number"),
        ("\n0.05,", "\n0.04,", r"row 6: time 0.040000 s repeats .*--resample"),
        ("\n0.05,", "\n0.01,", r"row 6: time 0.010000 s is before"),
    ],
)
def test_damaged_rows_are_named(
    tmp_path: Path, truth: Recording, bring, old: str, new: str, message: str
) -> None:
    path = table(
        tmp_path / "log.csv",
        "t,ax,ay,az,gx,gy,gz",
        truth.time_s,
        truth.specific_force_m_s2,
        truth.angular_rate_rad_s,
    )
    path.write_text(path.read_text().replace(old, new, 1))
    with pytest.raises(RecordingError, match=message):
        bring(path)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "no format that is known"),
        (b"hello\nworld\n", "no format that is known"),
        (b"a,b\n" * 50, "no format that is known"),
        (b"\0\1\2" * 500, "no format that is known"),
    ],
)
def test_no_table(tmp_path: Path, bring, content: bytes, message: str) -> None:
    path = tmp_path / "log.dat"
    path.write_bytes(content)
    with pytest.raises(RecordingError, match=message):
        bring(path)


def test_zero_bytes_are_no_text(tmp_path: Path, truth: Recording, bring) -> None:
    path = table(
        tmp_path / "log.csv",
        "t,ax,ay,az,gx,gy,gz,note",
        truth.time_s,
        truth.specific_force_m_s2,
        truth.angular_rate_rad_s,
        truth.time_s,
    )
    path.write_bytes(path.read_bytes() + b"\0" * 50)
    with pytest.raises(RecordingError, match=r"byte \d+ is zero"):
        bring(path)


def test_huge_header_is_refused_quickly(tmp_path: Path, bring) -> None:
    path = tmp_path / "log.csv"
    path.write_text("a," * 500_000 + "\n" + "1," * 500_000 + "\n")
    with pytest.raises(RecordingError, match="the limit is 20000"):
        bring(path)
    path.write_text("1," * 5000 + "\n")
    with pytest.raises(RecordingError, match="5000 columns; the limit is 1000"):
        bring(path, "csv")


cell = st.one_of(
    st.floats(width=32).map(str),
    st.integers(-40000, 40000).map(str),
    st.sampled_from(["", "nan", "ax", "gy", "time", "x y", "1,5", "#", '"', "a/g:", "AcX = 3"]),
)


line = st.lists(cell, max_size=9).flatmap(
    lambda cells: st.sampled_from(list(",;\t| ")).map(lambda mark: mark.join(cells))
)


@settings(
    max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(lines=st.lists(line, max_size=12))
def test_any_text_is_read_or_refused_in_one_line(tmp_path: Path, lines: list[str]) -> None:
    path = tmp_path / "fuzz.csv"
    path.write_text("\n".join(lines), encoding="utf-8")
    said = outcome(path)
    assert "\n" not in said
    assert len(said) < 2000


def outcome(path: Path) -> str:
    try:
        return f"{len(import_recording(path, ImportOptions(rate_hz=100.0)).recording)} samples"
    except HostkitError as error:
        return str(error)


@settings(
    max_examples=100, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(content=st.binary(max_size=300))
def test_any_bytes_are_refused_in_one_line(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "fuzz.bin"
    path.write_bytes(content)
    with pytest.raises(HostkitError) as caught:
        import_recording(path, ImportOptions(rate_hz=100.0))
    assert "\n" not in str(caught.value)


@settings(
    max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(
    order=st.permutations(["t", "ax", "ay", "az", "gx", "gy", "gz"]),
    delimiter=st.sampled_from(list(",;\t|")),
    time=st.sampled_from([1.0, 1e3, 1e6, 1e9]),
    force=st.sampled_from([1.0, 1 / G, 1e3 / G, 8192 / G]),
    rate=st.sampled_from([1.0, 1 / DEG, 32768 / (500 * DEG)]),
)
def test_any_order_and_units(
    tmp_path: Path, truth: Recording, bring, order, delimiter, time, force, rate
) -> None:
    whole = rate > 1 / DEG
    columns = {"t": truth.time_s * time}
    for n, axis in enumerate("xyz"):
        columns[f"a{axis}"] = truth.specific_force_m_s2[:, n] * force
        scaled = truth.angular_rate_rad_s[:, n] * rate
        columns[f"g{axis}"] = np.round(scaled) if whole else scaled
        if force > 1e3 / G:
            columns[f"a{axis}"] = np.round(columns[f"a{axis}"])
    path = table(
        tmp_path / "log.csv", delimiter.join(order), *(columns[name] for name in order),
        delimiter=delimiter,
    )  # fmt: skip
    same(bring(path).recording, truth, 1e-3)
