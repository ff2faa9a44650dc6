"""Faults met by images that read the sensor's FIFO: each is survived, counted and told."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from boards import TARGET_TOOLS, require_or_skip
from designs import design

from hostkit.emulation.fault import parse_fault
from hostkit.emulation.run import build, emulate
from hostkit.recordings import Recording
from hostkit.render import generate, write
from hostkit.render.options import FirmwareOptions
from hostkit.targets import TARGETS

SAYS = "MPU-6050: "
RESETTING = (f"{SAYS}had reset itself, restart #1", f"{SAYS}bus failed, restart #1")
ROWS = 200

PROMISES = (
    # fault, one of these texts, samples lost at most, restarts, samples sent again at most
    ("fifo-overflow=80@0.5", (f"{SAYS}FIFO overflow #1",), 2, 0, 0),
    ("torn-count=1@0.5", (), 0, 0, 0),
    ("misaligned=1@0.5", (f"{SAYS}FIFO misaligned #1",), 2, 0, 0),
    ("brown-out-write=12@0", RESETTING, 0, None, 0),
    ("self-reset@0.5", (f"{SAYS}had reset itself, restart #1",), 1, 1, 0),
    ("nack-address=3@0.5", (), 0, 0, 0),
    ("stuck-sda=9@0.5", (), 0, 0, 0),
    ("clock-stretch=3000@0.5", (), 0, 0, 0),
    ("register-upset=0x6A40@0.5", (f"{SAYS}restart, register 0x6A was 0x00 #1",), 15, 1, 0),
    ("frozen-data@0.5", (f"{SAYS}frozen, restart #1",), 50, 1, 49),
)


def recording() -> Recording:
    rng = np.random.default_rng(5)
    return Recording(
        name="wild",
        time_s=np.arange(ROWS) / 100.0,
        rate_hz=100.0,
        angular_rate_rad_s=rng.normal(0.0, 3.0, (ROWS, 3)),
        specific_force_m_s2=rng.normal(0.0, 8.0, (ROWS, 3)),
        valid=np.ones(ROWS, dtype=np.bool_),
    )


@pytest.fixture(scope="module")
def code(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """Give the built code of a target, built once."""
    built: dict[str, Path] = {}

    def of(target: str) -> Path:
        require_or_skip(*TARGET_TOOLS[target])
        if target not in built:
            folder = tmp_path_factory.mktemp(target)
            options = FirmwareOptions(acquisition="fifo")
            write(generate(design(), TARGETS[target], options), folder)
            build(folder, TARGETS[target])
            built[target] = folder
        return built[target]

    return of


@pytest.mark.parametrize("promise", PROMISES, ids=lambda promise: promise[0])
@pytest.mark.parametrize("target", ["host", "atmega328p", "rp2040", "stm32f103"])
def test_the_promise_is_kept(
    code: Callable[[str], Path],
    target: str,
    promise: tuple[str, tuple[str, ...], int, int | None, int],
) -> None:
    fault, texts, lost, restarts, repeated = promise
    result = emulate(
        code(target), TARGETS[target], design(), recording(), faults=(parse_fault(fault),)
    )
    report = result.fault_report
    assert report is not None
    assert (report.struck, result.mismatches, report.recovered) == (1, 0, True)
    assert len(report.texts) == bool(texts)
    assert set(report.texts) <= set(texts)
    assert result.missing <= lost
    assert restarts is None or report.restarts == restarts
    assert report.repeated <= repeated
    assert report.errors > 0
