"""A filter with every parameter on all three targets, and what the monitor says of the AVR."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from boards import TARGET_TOOLS, changed, copied, generated, hear, require_or_skip, stimulus
from designs import all_parameters

from hostkit.emulation import avr_board, host_board
from hostkit.emulation.run import build, emulate
from hostkit.filters.complementary import lower, run_integer
from hostkit.monitor import Session
from hostkit.recordings import Recording
from hostkit.simulation import SensorErrors, simulate
from hostkit.targets import TARGETS
from hostkit.validation import Thresholds

DESIGN = all_parameters()


@pytest.fixture(scope="module")
def recording() -> Recording:
    return simulate(
        "steps",
        duration_s=10.0,
        rate_hz=DESIGN.rate_hz,
        sensor=DESIGN.sensor,
        errors=SensorErrors(vibration_m_s2=2.0),
        rng=np.random.default_rng(1),
    )


@pytest.fixture(scope="module")
def code(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """Give the built code of a target, built once."""
    built: dict[str, Path] = {}

    def of(target: str) -> Path:
        require_or_skip(*TARGET_TOOLS[target])
        if target not in built:
            built[target] = generated(target, tmp_path_factory.mktemp(target), DESIGN)
            build(built[target], TARGETS[target])
        return built[target]

    return of


@pytest.mark.parametrize("target", TARGETS.names())
def test_every_sample_equals_the_integer_model(code, recording: Recording, target: str) -> None:
    result = emulate(code(target), TARGETS[target], DESIGN, recording)
    assert result.passed
    assert (result.samples, result.missing, result.mismatches) == (len(recording), 0, 0)
    assert 0.0 < np.degrees(result.max_abs_error_rad) < 0.01


@pytest.mark.parametrize("board", [host_board, avr_board])
def test_the_hidden_words_are_those_of_the_integer_model(code, board) -> None:
    folder = code("host" if board is host_board else "atmega328p")
    samples = hear(board.run(folder, stimulus(300, DESIGN))).samples
    accel, gyro = (np.array([getattr(s, name) for s in samples]) for name in ("accel", "gyro"))
    wanted = run_integer(lower(DESIGN), accel, gyro)
    np.testing.assert_array_equal([[s.roll, s.pitch, *s.hidden] for s in samples], wanted)


class Stream:
    """What a board sent, as a port that ends."""

    live, state, epoch, overrun_bytes = False, "connected", 0, 0

    def __init__(self, stream: bytes) -> None:
        self._stream = stream

    def read(self, timeout_s: float) -> bytes | None:
        piece, self._stream = self._stream[:4096], self._stream[4096:]
        return piece or None

    def write(self, data: bytes) -> None:
        pass

    def close(self) -> None:
        pass


def judged(folder: Path):
    stream = avr_board.run(folder, stimulus(300, DESIGN)).stream
    port = Stream(stream)
    return Session(design=DESIGN, transport=port, thresholds=Thresholds(max_rms_deg=0.02)).run()


def test_the_monitor_passes_the_avr(code) -> None:
    report = judged(code("atmega328p")).report
    assert (report.verdict, report.checked, report.mismatches) == ("pass", 300, 0)


@pytest.mark.parametrize(
    ("file", "old", "new"),
    [
        ("hk_filter.h", "INTEGRAL_GAIN_RAW  INT32_C({gain})", "INTEGRAL_GAIN_RAW  INT32_C({less})"),
        ("hk_filter.c", "*bias - change", "(*bias - change) ^ 1"),
        ("hk_filter.h", "GATE_LOWEST  UINT32_C(2174", "GATE_LOWEST  UINT32_C(2164"),
        ("hk_telemetry.c", "HK_FILTER_HIDDEN(&app->filter);", "{{0}};"),
    ],
)
def test_the_monitor_finds_one_wrong_bit(code, tmp_path: Path, file: str, old: str, new: str):
    gain = lower(DESIGN).integral.gain.raw
    folder = copied(code("atmega328p"), tmp_path / "code")
    values = {"gain": gain, "less": gain ^ 1}
    changed(folder / file, old.format(**values), new.format(**values))
    avr_board.build(folder)
    report = judged(folder).report
    assert (report.verdict, report.digest_ok) == ("fail", True)
    assert report.mismatches > 0
