"""Onboard logs of autopilots: DataFlash by its format records, ULog by pyulog."""

from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from foreign_logs import close, dataflash, highres, link, tilted, tlog, ulog
from pymavlink.DFReader import DFReader_binary
from pyulog.core import ULog

from hostkit.errors import RecordingError


def test_dataflash(tmp_path: Path, truth, bring, to_frd, tilt_of) -> None:
    path = tmp_path / "00000001.BIN"
    path.write_bytes(dataflash(truth, to_frd, tilt_of, (0, 1)))
    with DFReader_binary(str(path)) as check:
        assert check.recv_match(type="IMU").GyrX == pytest.approx(truth.angular_rate_rad_s[0, 0])
    imported = bring(path)
    assert imported.format == "ardupilot"
    close(imported.recording, truth, 1e-5, 1e-6)
    assert tilted(imported.recording, truth) < 2e-3
    assert "the samples are IMU 0, not 1" in imported.guessed
    twice = bring(path, instance=1, reference=False).recording
    np.testing.assert_allclose(twice.specific_force_m_s2, 2 * truth.specific_force_m_s2, atol=1e-5)
    assert twice.up_reference is None
    with pytest.raises(RecordingError, match="no samples of IMU 3; it has IMU: 0, 1"):
        bring(path, instance=3)


def test_dataflash_cut_in_its_last_record(tmp_path: Path, truth, bring, to_frd, tilt_of) -> None:
    path = tmp_path / "00000001.BIN"
    content = dataflash(truth, to_frd, tilt_of, (0,))
    path.write_bytes(content[:-5])
    got = bring(path, reference=False).recording
    assert len(got) == len(truth) - 1


def test_ulog(tmp_path: Path, truth, bring, to_frd, tilt_of) -> None:
    path = tmp_path / "flight.ulg"
    path.write_bytes(ulog(truth, to_frd, tilt_of))
    again = BytesIO()
    ULog(str(path)).write_ulog(again)
    path.write_bytes(again.getvalue())
    imported = bring(path)
    assert imported.format == "ulog"
    close(imported.recording, truth, 1e-5, 1e-6)
    assert tilted(imported.recording, truth) < 2e-3
    assert bring(path, reference=False).recording.up_reference is None
    with pytest.raises(RecordingError, match="no samples of sensor_combined 2"):
        bring(path, instance=2)


@pytest.mark.parametrize("suffix", [".tlog", ".bin", ".ulg"])
@pytest.mark.parametrize("keep", [0, 1, 9, 20, 60, 200, 1000])
def test_cut_and_garbled_logs_are_refused_or_shorter(
    tmp_path: Path, truth, bring, to_frd, tilt_of, suffix: str, keep: int
) -> None:
    path = tmp_path / f"log{suffix}"
    if suffix == ".tlog":
        tlog(path, highres(truth, to_frd, link()))
    else:
        maker = dataflash if suffix == ".bin" else ulog
        path.write_bytes(
            dataflash(truth, to_frd, tilt_of, (0,)) if maker is dataflash
            else ulog(truth, to_frd, tilt_of)
        )  # fmt: skip
    noise = np.random.default_rng(keep).bytes(3000)
    path.write_bytes(path.read_bytes()[:keep] + noise)
    try:
        imported = bring(path)
    except RecordingError as error:
        said = str(error)
    else:
        said = f"{len(imported.recording)} samples"
        assert len(imported.recording) < 30
    assert "\n" not in said
    assert str(path) in said or "samples" in said
