"""Files of parameters, to MAVProxy's loader and back."""

import contextlib
import io
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pymavlink.mavparm import MAVParmDict

from hostkit.errors import HostkitError
from hostkit.link.device.parameter_compare import differences
from hostkit.link.device.parameter_entry import ParameterEntry
from hostkit.link.device.parameter_file import (
    number_text,
    read_parameter_file,
    write_parameter_file,
)

VALUES = {
    "SYS_ID": 1.0,
    "FILT_TAU": float(np.float32(1.5000054)),
    "GYRO_BIAS_ROLL": float(np.float32(-1.2345678e-7)),
    "TILT_OFS_PITCHXX": 0.0,
}


def entries(values: dict[str, float]) -> list[ParameterEntry]:
    return [ParameterEntry(name=n, value=v, index=i) for i, (n, v) in enumerate(values.items())]


def loaded_by_mavproxy(path: Path) -> dict[str, float]:
    parameters = MAVParmDict()
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        assert parameters.load(str(path))
    assert "Invalid" not in said.getvalue()
    return dict(parameters)


def test_mavproxy_reads_what_is_written_to_the_last_bit(tmp_path: Path) -> None:
    path = tmp_path / "a.parm"
    write_parameter_file(path, VALUES.items(), remarks=("hostkit 1, design abc",))
    assert path.read_text().splitlines()[0] == "# hostkit 1, design abc"
    assert {n: float(np.float32(v)) for n, v in loaded_by_mavproxy(path).items()} == VALUES


def test_what_mavproxy_writes_is_read_and_is_no_difference(tmp_path: Path) -> None:
    path = tmp_path / "b.parm"
    theirs = MAVParmDict()
    theirs.update(VALUES)
    theirs.save(str(path))
    rows = read_parameter_file(path)
    assert {row.name for row in rows} == set(VALUES)
    assert differences(entries(VALUES), rows, missing=True) == ()


def test_what_is_written_is_read_back(tmp_path: Path) -> None:
    path = tmp_path / "c.parm"
    write_parameter_file(path, VALUES.items())
    rows = read_parameter_file(path)
    assert {row.name: float(np.float32(row.value)) for row in rows} == VALUES
    assert [row.name for row in rows] == sorted(VALUES)


@given(st.floats(width=32, allow_nan=False, allow_infinity=False))
def test_every_number_of_32_bits_survives(value: float) -> None:
    assert float(np.float32(float(number_text(value)))) == value


def test_remarks_commas_tabs_and_empty_lines_are_understood(tmp_path: Path) -> None:
    path = tmp_path / "d.parm"
    path.write_bytes(b"\xef\xbb\xbf# head\r\n\r\nA\t1  # one\r\nB,2\r\n  C   -3e-2\n")
    rows = read_parameter_file(path)
    assert [(row.name, row.value, row.line) for row in rows] == [
        ("A", 1.0, 3),
        ("B", 2.0, 4),
        ("C", -0.03, 5),
    ]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("A 1\nB\n", "line 2: 'B' is not a name and a value"),
        ("A 1\n1 1 B 2 9\n", "line 2: '1 1 B 2 9' is not a name"),
        ("A one\n", "line 1: A has the value 'one', which is no number"),
        ("A nan\n", "line 1: A has the value 'nan'"),
        ("A 1e999\n", "line 1: A has the value '1e999'"),
        ("A 1_0\n", "line 1: A has the value '1_0'"),
        ("A 0x10\n", "line 1: A has the value '0x10'"),
        ("ABCDEFGHIJKLMNOPQ 1\n", "line 1: 'ABCDEFGHIJKLMNOPQ' is no name"),
        ("Ä 1\n", "line 1: 'Ä' is no name"),
        ("A 1\nB 2\nA 3\n", "line 3: A stands in line 1 already"),
        ("# nothing\n", "has no parameter in it"),
        ("".join(f"P{i} 1\n" for i in range(257)), "more than 256 parameters"),
        ("#" * (1 << 21), "more than 1 MiB"),
    ],
)
def test_what_is_no_file_of_parameters_is_said_with_its_line(
    tmp_path: Path, text: str, says: str
) -> None:
    path = tmp_path / "e.parm"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(HostkitError) as raised:
        read_parameter_file(path)
    assert says in str(raised.value)


def test_bytes_that_are_no_text_and_missing_files_are_said(tmp_path: Path) -> None:
    path = tmp_path / "f.parm"
    path.write_bytes(b"A \xff\xfe")
    with pytest.raises(HostkitError, match="is no file of parameters"):
        read_parameter_file(path)
    with pytest.raises(HostkitError, match="cannot be read"):
        read_parameter_file(tmp_path / "none.parm")


@pytest.mark.parametrize(
    ("name", "device", "file", "same"),
    [
        ("FILT_TAU", 2.4999812, 2.5, True),
        ("FILT_TAU", 2.4999, 2.5, False),
        ("SYS_ID", 1.0, 2.0, False),
        ("GYRO_BIAS_ROLL", 4e-7, 0.0, True),
        ("GYRO_BIAS_ROLL", 2e-6, 0.0, False),
    ],
)
def test_what_device_and_file_round_is_no_difference(
    tmp_path: Path, name: str, device: float, file: float, same: bool
) -> None:
    path = tmp_path / "g.parm"
    path.write_text(f"{name} {file}\n")
    found = differences(entries({name: device}), read_parameter_file(path))
    assert (found == ()) is same


def test_what_one_side_lacks_is_a_difference_if_asked_for(tmp_path: Path) -> None:
    path = tmp_path / "h.parm"
    path.write_text("A 1\nB 2\n")
    rows = read_parameter_file(path)
    assert differences(entries({"A": 1.0, "C": 3.0}), rows) == ()
    found = differences(entries({"A": 1.0, "C": 3.0}), rows, missing=True)
    assert [(d.name, d.device, d.file) for d in found] == [("B", None, 2.0), ("C", 3.0, None)]
