"""A served board under the real monitor: it passes, and what is wrong is found."""

import json
from contextlib import AbstractContextManager
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from designs import design
from live import emulated

from hostkit.cli.main import run
from hostkit.design_file import save_design
from hostkit.emulation.tools import TOOLS, find
from hostkit.filters.complementary import parameters
from hostkit.recordings import save
from hostkit.simulation import SensorErrors, simulate
from hostkit.targets import TARGETS

LIVE_S = 2.0
LEAST_SHARE = 0.5
"""What an emulator on a busy machine sends of what is due; none of it may be lost."""
SLOWEST_MS, SESSIONS = 100.0, 5
DESIGN = design(accel_full_scale_g=4)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A design and a recording."""
    missing = [t.name for t in TOOLS if not find(t).found]
    if missing:
        pytest.skip(f"not installed: {', '.join(missing)}")
    path = tmp_path_factory.mktemp("live")
    recording = simulate(
        "sine-sweep",
        duration_s=5.0,
        rate_hz=100.0,
        sensor=DESIGN.sensor,
        errors=SensorErrors(),
        rng=np.random.default_rng(1),
    )
    save(recording, path / "sweep.csv")
    save_design(DESIGN, path / "design.json")
    return path


@pytest.fixture(scope="module", params=["atmega328p", "host"])
def code(request: pytest.FixtureRequest, folder: Path) -> Path:
    out = folder / request.param
    arguments = ["generate", str(folder / "design.json"), "--target", request.param]
    assert run([*arguments, "--out", str(out)]) == 0
    return out


def served(folder: Path, code: Path) -> AbstractContextManager[str]:
    target = code.name.split("-")[0]
    recording = folder / "sweep.csv"
    return emulated(folder / "design.json", target, recording, "--code", str(code))


def monitor(capsys: pytest.CaptureFixture[str], design_file: Path, port: str, *more: str):
    arguments = ["monitor", str(design_file), "--port", port, "--duration", str(LIVE_S), "--json"]
    code = run([*arguments, *more])
    out, err = capsys.readouterr()
    return code, json.loads(out), err


def test_right_device_passes_twice_and_another_design_is_refused(folder, code, capsys) -> None:
    other = folder / "other.json"
    save_design(replace(DESIGN, parameters=parameters(0.99650001)), other)
    with served(folder, code) as port:
        for attempt in range(2):
            tlog = folder / f"{code.name}{attempt}.tlog"
            exit_code, document, _ = monitor(
                capsys, folder / "design.json", port, "--record", str(tlog)
            )
            assert (exit_code, document["verdict"]) == (0, "pass")
            assert (document["lost"], document["mismatches"]) == (0, 0)
            assert document["samples"] > LEAST_SHARE * LIVE_S * DESIGN.rate_hz
            _, again, _ = monitor(capsys, folder / "design.json", f"file:{tlog}")
            assert (again["samples"], again["verdict"]) == (document["samples"], "pass")
        exit_code, document, err = monitor(capsys, other, port)
        assert (exit_code, document["verdict"], document["digest_ok"]) == (3, "refused", False)
        assert "runs design" in err


def test_one_changed_bit_of_the_filter_is_found(folder, code, capsys, tmp_path: Path) -> None:
    changed = tmp_path / f"{code.name}-changed"
    for path in code.rglob("*"):
        if path.is_file():
            copy = changed / path.relative_to(code)
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_bytes(path.read_bytes())
    header = changed / "hk_filter.h"
    line = next(x for x in header.read_text().splitlines() if "HK_BLEND_RAW" in x)
    raw = int(line.split("INT32_C(")[1].split(")")[0])
    header.write_text(header.read_text().replace(f"INT32_C({raw})", f"INT32_C({raw ^ 1})"))
    with served(folder, changed) as port:
        exit_code, document, err = monitor(capsys, folder / "design.json", port)
    assert (exit_code, document["verdict"], document["digest_ok"]) == (3, "fail", True)
    assert document["mismatches"] > 0
    assert "integer model" in err
    capsys.readouterr()
    arguments = ["emulate", str(folder / "design.json"), "--target", code.name]
    arguments += ["--code", str(changed), "--recording", str(folder / "sweep.csv"), "--json"]
    assert run(arguments) == 3
    assert json.loads(capsys.readouterr().out)["mismatches"] > 0


@pytest.mark.parametrize("code", ["host"], indirect=True)
def test_timing_is_told_and_plausible(folder: Path, code: Path, capsys) -> None:
    """A busy machine can only blur what the link shows, so the best of some sessions counts."""
    with served(folder, code) as port:
        for _ in range(SESSIONS):
            _, document, _ = monitor(capsys, folder / "design.json", port)
            timing = document["timing"]
            assert None not in (timing["round_trip_ms"], timing["latency"], timing["jitter"])
            if is_plausible(timing):
                return
    pytest.fail(f"{timing} is not plausible, as were {SESSIONS - 1} before")


def is_plausible(timing: dict) -> bool:
    """Tell whether all times are ordered, above 0 and below what an idle machine needs."""
    spreads = [timing["latency"], timing["jitter"]]
    return 0.0 < timing["round_trip_ms"] < SLOWEST_MS and all(
        0.0 <= x["median_ms"] <= x["p95_ms"] <= x["max_ms"] and x["p95_ms"] < SLOWEST_MS
        for x in spreads
    )


def test_targets_with_a_port_are_the_microcontrollers() -> None:
    assert {t.name for t in TARGETS if t.kind == "mcu"} == {
        "host",
        "atmega328p",
        "rp2040",
        "stm32f103",
        "linux",
    }
