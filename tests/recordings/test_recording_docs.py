"""The examples of docs/recordings.md are run as they stand there."""

import re
from pathlib import Path

import pytest

from hostkit.recordings import load

PAGE = Path(__file__).resolve().parents[2] / "docs" / "recordings.md"


def block(language: str) -> str:
    found = re.search(rf"```{language}\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    assert found is not None
    return found.group(1)


def test_csv_example_loads(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text(block("csv"), encoding="utf-8")
    recording = load(tmp_path / "a.csv")
    assert (len(recording), recording.rate_hz, recording.licence) == (2, 100.0, "CC0-1.0")
    assert recording.up_reference is not None


def test_conversion_example_makes_a_recording(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    rows = [f"{10 * k},{k % 7},0,0,0,0,1" for k in range(20)]
    (tmp_path / "log.csv").write_text("\n".join(("t_ms,gx,gy,gz,ax,ay,az", *rows)))
    exec(compile(block("python"), str(PAGE), "exec"), {})
    recording = load(tmp_path / "log.npz")
    assert (len(recording), recording.rate_hz, recording.sensor) == (20, 100.0, "MPU-6050")
