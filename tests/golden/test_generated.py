import shutil
from pathlib import Path

import numpy as np
import pytest
from boards import changed
from c_filter import c_response
from samples import FPGA_NAME, SAMPLES, VECTORS, Sample, committed_files

from hostkit.design_file import design_text
from hostkit.emulation.ghdl import analyse, simulate
from hostkit.errors import ToolMissingError
from hostkit.filters import FILTERS
from hostkit.filters.complementary import lower
from hostkit.records import AXES

COLUMN = {"roll": 0, "pitch": 1}


def python_response(sample: Sample, counts: np.ndarray) -> np.ndarray:
    """Roll, pitch, restarted and hidden words of the integer model, as the device lays them out."""
    filter_, axes = FILTERS[sample.design.filter], AXES[sample.design.axes]
    state = filter_.run_integer(filter_.lower(sample.design), counts[:, :3], counts[:, 3:])
    out = np.zeros((len(counts), 3), dtype=np.int64)
    for i, axis in enumerate(axes):
        out[:, COLUMN[axis]] = state[:, i]
    out[0, 2] = 1
    return np.hstack([out, state[:, len(axes) :]])


def expected_files(sample: Sample) -> dict[str, str]:
    files = {"design.json": design_text(sample.design)}
    rows = np.hstack([sample.counts, python_response(sample, sample.counts)])
    files[VECTORS] = sample.header + "\n" + "".join(" ".join(map(str, row)) + "\n" for row in rows)
    return files | committed_files(sample)


@pytest.fixture(params=SAMPLES, ids=str)
def sample(request: pytest.FixtureRequest) -> Sample:
    return request.param


def test_committed_samples_are_what_is_rendered(
    sample: Sample, request: pytest.FixtureRequest
) -> None:
    wanted = expected_files(sample)
    if request.config.getoption("--update-golden"):
        update(sample.folder, wanted)
    found = {
        p.relative_to(sample.folder).as_posix(): p.read_bytes()
        for p in sample.folder.rglob("*")
        if p.is_file()
    }
    assert sorted(found) == sorted(wanted)
    for path, content in wanted.items():
        assert found[path] == content.encode("ascii"), f"{path} is stale: `make goldens`"


def update(folder: Path, wanted: dict[str, str]) -> None:
    for path in folder.rglob("*"):
        if path.is_file() and path.relative_to(folder).as_posix() not in wanted:
            path.unlink()
    for name, content in wanted.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content.encode("ascii"))


def committed_vectors(sample: Sample) -> tuple[np.ndarray, np.ndarray]:
    rows = np.loadtxt(sample.folder / VECTORS, dtype=np.int64, skiprows=1)
    return rows[:, :6], rows[:, 6:]


def test_python_gives_the_committed_vectors(sample: Sample) -> None:
    counts, response = committed_vectors(sample)
    np.testing.assert_array_equal(python_response(sample, counts), response)


def test_committed_c_gives_the_committed_vectors(sample: Sample, host_cc, tmp_path: Path) -> None:
    counts, response = committed_vectors(sample)
    got = c_response(host_cc, sample.folder / "host", counts, tmp_path / "vectors")
    words = response.shape[1]
    np.testing.assert_array_equal(got[:, :words], response)
    assert not got[:, words:].any()


def test_committed_vhdl_gives_the_committed_vectors(sample: Sample, tmp_path: Path) -> None:
    counts, response = committed_vectors(sample)
    code = tmp_path / "vhdl"
    code.mkdir()
    for owner in (SAMPLES[0], sample):
        for path in (owner.folder / FPGA_NAME).glob("*.vhd"):
            (code / path.name).write_bytes(path.read_bytes())
    try:
        analyse(code)
        run = simulate(code, counts[:, :3], counts[:, 3:])
    except ToolMissingError as error:
        pytest.skip(str(error))
    got = np.hstack([run.angle_raw, run.restarted[:, None].astype(np.int64), run.hidden_raw])
    words = response.shape[1]
    np.testing.assert_array_equal(got[:, :words], response)
    assert not got[:, words:].any()


def test_c_harness_can_fail(host_cc, tmp_path: Path) -> None:
    """One bit of one coefficient turned over must show."""
    sample = SAMPLES[0]
    counts, response = committed_vectors(sample)
    raw = FILTERS["complementary"].lower(sample.design).blend.raw
    code = changed_header(sample, tmp_path / "host", f"INT32_C({raw})", f"INT32_C({raw ^ 1})")
    got = c_response(host_cc, code, counts, tmp_path / "vectors")
    assert (got[:, : response.shape[1]] != response).any()


def changed_header(sample: Sample, code: Path, old: str, new: str) -> Path:
    """Copy the host's code of a sample with one change of its filter's header."""
    shutil.copytree(sample.folder / "host", code)
    changed(code / "hk_filter.h", old, new)
    return code


def test_the_vectors_reach_the_limit_and_both_bounds_of_the_gate() -> None:
    spec = lower(SAMPLES[-1].design)
    counts, response = committed_vectors(SAMPLES[-1])
    limit = spec.integral.limit_raw
    assert {limit, -limit} <= set(response[:, 3:].ravel().tolist())
    assert np.abs(response[:, 3:]).max() == limit
    low, high = spec.gate.lowest, spec.gate.highest
    squares = (counts[:, :3] ** 2).sum(axis=1).tolist()
    assert {low, high, high + 1} <= set(squares)  # no three squares add up to low - 1


@pytest.mark.parametrize(
    "name",
    [
        "RATE_GAIN_ROLL_RAW",
        "RATE_GAIN_PITCH_RAW",
        "INTEGRAL_GAIN_RAW",
        "TILT_OFFSET_ROLL",
        "TILT_OFFSET_PITCH",
        "GATE_LOWEST",
        "GATE_HIGHEST",
        "BIAS_LIMIT",
        "BIAS_START_ROLL",
        "BIAS_START_PITCH",
    ],
)
def test_every_constant_counts_to_its_last_bit(host_cc, tmp_path: Path, name: str) -> None:
    """One more in any constant of the C changes an answer to the committed vectors."""
    sample = SAMPLES[-1]
    counts, response = committed_vectors(sample)
    header = (sample.folder / "host" / "hk_filter.h").read_text()
    old = next(line for line in header.splitlines() if line.startswith(f"#define HK_{name} "))
    raw = int(old.split("_C(")[1].split(")")[0])
    code = changed_header(sample, tmp_path / "host", old, old.replace(str(raw), str(raw + 1), 1))
    got = c_response(host_cc, code, counts, tmp_path / "vectors")
    assert (got != response).any()
