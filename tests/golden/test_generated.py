from pathlib import Path

import numpy as np
import pytest
from samples import HEADER, SAMPLES, TARGET_NAMES, VECTORS, Sample, stimulus

from hostkit.design_file import design_text
from hostkit.emulation.ghdl import analyse, simulate
from hostkit.errors import ToolMissingError
from hostkit.filters import FILTERS
from hostkit.records import AXES
from hostkit.render import render_target
from hostkit.targets import TARGETS

COLUMN = {"roll": 0, "pitch": 1}


def python_response(sample: Sample, counts: np.ndarray) -> np.ndarray:
    """Roll, pitch and restarted of the integer model, as the device lays them out."""
    filter_ = FILTERS[sample.design.filter]
    angle = filter_.run_integer(filter_.lower(sample.design), counts[:, :3], counts[:, 3:])
    out = np.zeros((len(counts), 3), dtype=np.int64)
    for i, axis in enumerate(AXES[sample.design.axes]):
        out[:, COLUMN[axis]] = angle[:, i]
    out[0, 2] = 1
    return out


def expected_files(sample: Sample) -> dict[str, str]:
    files = {"design.json": design_text(sample.design)}
    rows = np.hstack([stimulus(), python_response(sample, stimulus())])
    files[VECTORS] = HEADER + "\n" + "".join(" ".join(map(str, row)) + "\n" for row in rows)
    for name in TARGET_NAMES:
        for file in render_target(sample.design, TARGETS[name]):
            files[f"{name}/{file.path}"] = file.content
    return files


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


def c_response(host_cc, code: Path, counts: np.ndarray, output: Path) -> np.ndarray:
    """What the C filter in a folder answers, built strictly and with sanitizers."""
    harness = Path(__file__).with_name("vector_main.c")
    sources = (harness, code / "hk_filter.c", code / "hk_cordic.c")
    program = host_cc.build(output, f"-I{code}", *sources)
    return np.array(host_cc.run(program, counts), dtype=np.int64)


def test_committed_c_gives_the_committed_vectors(sample: Sample, host_cc, tmp_path: Path) -> None:
    counts, response = committed_vectors(sample)
    got = c_response(host_cc, sample.folder / "host", counts, tmp_path / "vectors")
    np.testing.assert_array_equal(got, response)


def test_committed_vhdl_gives_the_committed_vectors(sample: Sample, tmp_path: Path) -> None:
    counts, response = committed_vectors(sample)
    code = tmp_path / "vhdl"
    code.mkdir()
    for path in (sample.folder / "spartan3adsp").iterdir():
        (code / path.name).write_bytes(path.read_bytes())
    try:
        analyse(code)
        run = simulate(code, counts[:, :3], counts[:, 3:])
    except ToolMissingError as error:
        pytest.skip(str(error))
    got = np.hstack([run.angle_raw, run.restarted[:, None].astype(np.int64)])
    np.testing.assert_array_equal(got, response)


def test_c_harness_can_fail(host_cc, tmp_path: Path) -> None:
    """One bit of one coefficient turned over must show."""
    sample = SAMPLES[0]
    counts, response = committed_vectors(sample)
    code = tmp_path / "host"
    code.mkdir()
    for path in (sample.folder / "host").glob("hk_*"):
        text = path.read_text()
        if path.name == "hk_filter.h":
            raw = FILTERS["complementary"].lower(sample.design).blend.raw
            assert f"INT32_C({raw})" in text
            text = text.replace(f"INT32_C({raw})", f"INT32_C({raw ^ 1})")
        (code / path.name).write_text(text)
    assert (c_response(host_cc, code, counts, tmp_path / "vectors") != response).any()
