import math
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from recorded import EVERY, SENSOR, recorded

from hostkit.cli.main import run
from hostkit.errors import RecordingError
from hostkit.recordings import LargeRecording, load, open_large, save
from hostkit.tuning import TuningOptions, tune
from hostkit.tuning.complementary import tuning_problem
from hostkit.tuning.kernel import PortableKernel, kernel


@pytest.fixture
def small_parts(monkeypatch):
    """Treat a thousand samples as large, and read them in odd parts."""
    monkeypatch.setattr("hostkit.recordings.large.LARGE_SAMPLES", 1000)
    monkeypatch.setattr("hostkit.recordings.large.PART_SAMPLES", 333)
    monkeypatch.setattr("hostkit.tuning.complementary.spool.PART_SAMPLES", 77)


@pytest.fixture
def stored(tmp_path: Path) -> Path:
    recording = recorded("random", duration_s=30.0)
    valid, lost = np.array(recording.valid), np.array(recording.up_reference)
    valid[:40] = valid[1500:1700] = False
    lost[660:680] = np.nan
    path = tmp_path / "long.npz"
    save(replace(recording, valid=valid, up_reference=lost), path)
    return path


def opened(path: Path) -> LargeRecording:
    large = open_large(path)
    assert large is not None
    return large


@pytest.mark.parametrize("axes", ["roll", "both"])
@pytest.mark.parametrize("free", [("tau",), EVERY], ids=["plain", "full"])
def test_parts_give_what_the_whole_gives(small_parts, stored, axes, free):
    options = TuningOptions(axes=axes, sensor=SENSOR, free=free, iterations=5, resamples=5)
    whole, parts = tune((load(stored),), options), tune((opened(stored),), options)
    assert parts.swarm.cost == pytest.approx(whole.swarm.cost, rel=1e-4)
    assert parts.held_out.each_rad == pytest.approx(whole.held_out.each_rad, rel=2e-3)
    assert math.degrees(parts.rms_rad) == pytest.approx(math.degrees(whole.rms_rad), abs=2e-3)
    assert parts.design.tuning.recordings == whole.design.tuning.recordings


@pytest.mark.parametrize("by", [PortableKernel(), kernel()], ids=["numpy", "c"])
def test_state_is_carried_over_parts_and_blocks(small_parts, stored, tmp_path, by):
    options = TuningOptions(axes="roll", sensor=SENSOR, free=EVERY)
    (tmp_path / "spool").mkdir()
    p = replace(tuning_problem((opened(stored),), options, tmp_path / "spool"), kernel=by)
    whole = replace(tuning_problem((load(stored),), options, tmp_path), kernel=by)
    x = (p.space.lower + p.space.upper)[None] / 2.0
    for blocks in (1, 3):
        found, wanted = (one.block_sums(x, blocks) for one in (p, whole))
        np.testing.assert_allclose(found, wanted, rtol=1e-4)


def test_what_a_large_recording_says_of_itself(small_parts, stored):
    large, whole = opened(stored), load(stored)
    assert (len(large), large.rate_hz, large.name) == (3000, 100.0, "long")
    assert large.sha256 == whole.sha256
    assert large.largest[0] == np.abs(whole.angular_rate_rad_s).max()
    times = np.concatenate([part.time_s for part in large.parts()])
    np.testing.assert_array_equal(times, whole.time_s)


def test_small_recordings_and_csv_are_read_whole(stored, tmp_path):
    assert open_large(stored) is None
    assert open_large(tmp_path / "anything.csv") is None


def rewritten(path: Path, change) -> Path:
    """Store the arrays anew, changed."""
    with np.load(path) as archive:
        arrays = dict(archive)
    change(arrays)
    other = path.with_name("changed.npz")
    np.savez(other, **arrays)
    return other


def test_faults_are_found_in_whatever_part(small_parts, stored):
    def not_a_number(arrays):
        arrays["gyro_rad_s"][2500, 1] = np.nan

    def backwards(arrays):
        arrays["time_s"][999] = 0.0

    def short(arrays):
        arrays["accel_m_s2"] = arrays["accel_m_s2"][:-1]

    for change, message in (
        (not_a_number, "rows 2332 to 2664.*angular rate y is nan"),
        (backwards, "row 1000: time 0.000000 s is not after"),
        (short, r"accel_m_s2 has shape \(2999, 3\)"),
    ):
        path = rewritten(stored, change)
        with pytest.raises(RecordingError, match=message):
            list(opened(path).parts())


def test_a_header_that_lies_is_refused(tmp_path: Path):
    """A billion rows in the header, ten in the file."""
    path = tmp_path / "lie.npz"
    with zipfile.ZipFile(path, "w") as archive, archive.open("time_s.npy", "w") as stream:
        np.lib.format.write_array_header_1_0(
            stream, {"descr": "<f8", "fortran_order": False, "shape": (10**9,)}
        )
        stream.write(np.arange(10.0).tobytes())
    with pytest.raises(RecordingError, match=r"time_s claims shape \(1000000000,\)"):
        open_large(path)


def test_a_truncated_file_is_one_line_and_no_design(small_parts, stored, tmp_path, capsys):
    broken = tmp_path / "broken.npz"
    content = stored.read_bytes()
    broken.write_bytes(content[: len(content) // 2])
    output = tmp_path / "d.json"
    assert run(["tune", str(broken), "-o", str(output)]) == 1
    message = capsys.readouterr().err
    assert "broken.npz" in message
    assert "Traceback" not in message
    assert not output.exists()


def test_command_line_reads_part_by_part(small_parts, stored, tmp_path, capsys):
    output = tmp_path / "d.json"
    assert run(["tune", str(stored), "--axes", "roll", "-o", str(output)]) == 0
    assert "3000 samples are read part by part" in capsys.readouterr().err
    assert output.exists()
