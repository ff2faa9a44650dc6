from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from boards import (
    ACTIVE,
    BOOT,
    CRITICAL,
    Collector,
    assert_every_row_once,
    changed,
    copied,
    hear,
    stimulus,
    with_faults,
)
from designs import design

from hostkit.emulation import host_board
from hostkit.emulation.board import Stimulus
from hostkit.errors import BuildError, EmulationError
from hostkit.filters import FILTERS


def test_every_row_arrives_once_with_the_counts_of_the_model(host_folder: Path) -> None:
    feels = stimulus()
    progress: list[int] = []
    run = host_board.run(host_folder, feels, progress=progress.append)
    heard = hear(run)
    assert_every_row_once(heard, feels)
    assert run.faults == ()
    assert progress[-1] == len(feels)
    assert heard.states[0] == BOOT
    assert set(heard.states[1:]) == {ACTIVE}


def test_angles_are_those_of_the_integer_model(host_folder: Path) -> None:
    samples = hear(host_board.run(host_folder, stimulus(1000))).samples
    filter_ = FILTERS["complementary"]
    accel, gyro = (np.array([getattr(s, name) for s in samples]) for name in ("accel", "gyro"))
    wanted = filter_.run_integer(filter_.lower(design()), accel, gyro)
    np.testing.assert_array_equal([[s.roll, s.pitch] for s in samples], wanted)
    assert len(samples) == 1000


def test_two_runs_are_equal(host_folder: Path) -> None:
    first, second = (host_board.run(host_folder, stimulus(50)).stream for _ in range(2))
    assert first == second


def test_wrong_identity_is_refused(host_folder: Path) -> None:
    run = host_board.run(host_folder, with_faults(stimulus(), who_am_i=0x12))
    heard = hear(run)
    assert heard.samples == []
    assert heard.states[0] == BOOT
    assert set(heard.states[1:]) == {CRITICAL}
    assert {t.text for t in heard.of("STATUSTEXT")} == {"MPU-6050 refused: WHO_AM_I is 0x12"}
    assert dict(run.faults)["stalled"] == 1


def test_serve_streams_in_real_time_and_loops(host_folder: Path) -> None:
    feels = stimulus(20)
    collector = Collector(lambda data: len(hear(data).samples) > 50)
    host_board.serve(host_folder, feels, collector.send, collector.stop)
    samples = hear(collector.data).samples
    assert [s.sequence for s in samples] == list(range(len(samples)))
    assert samples[0].accel == samples[20].accel == samples[40].accel
    assert samples[0].accel != samples[1].accel


def test_a_looping_stimulus_is_not_run(host_folder: Path) -> None:
    with pytest.raises(EmulationError, match="never ends"):
        host_board.run(host_folder, replace(stimulus(3), loop=True))


def test_a_compiler_error_is_the_message(host_folder: Path, tmp_path: Path) -> None:
    folder = copied(host_folder, tmp_path / "code")
    changed(folder / "hk_app.c", "app->system_status = status;", "app->system_status = nothing;")
    with pytest.raises(BuildError, match=r"hk_app\.c:\d+:\d+: error: .*nothing"):
        host_board.build(folder)


def test_what_is_not_there_is_said(tmp_path: Path) -> None:
    with pytest.raises(BuildError, match="no Makefile"):
        host_board.build(tmp_path)
    with pytest.raises(BuildError, match="has not been built"):
        host_board.run(tmp_path, stimulus(3))


def test_a_crash_is_reported_with_its_reason(host_folder: Path, tmp_path: Path) -> None:
    folder = copied(host_folder, tmp_path / "code")
    changed(
        folder / "hk_app.c",
        "latest->sequence = app->samples++;",
        "latest->sequence = app->samples++;\n    if (app->samples > 5U) {\n"
        "        *(volatile int *)(uintptr_t)app->samples = 0;\n    }",
    )
    host_board.build(folder, sanitize=True)
    with pytest.raises(
        EmulationError,
        match=r"firmware failed with exit code \d+: .*(sanitizer|Sanitizer|runtime error)",
    ):
        host_board.run(folder, stimulus(20))
    with pytest.raises(EmulationError, match="firmware failed"):
        host_board.serve(folder, stimulus(20), lambda _: None, lambda: False)


def test_stimulus_is_checked() -> None:
    good = stimulus(4)
    with pytest.raises(EmulationError, match="shape"):
        replace(good, temperature_deg_c=np.zeros(5))
    with pytest.raises(EmulationError, match="finite"):
        replace(good, temperature_deg_c=np.array([0.0, np.nan, 0.0, 0.0]))
    with pytest.raises(EmulationError, match="N>0"):
        Stimulus(
            angular_rate_rad_s=np.zeros((0, 3)),
            specific_force_m_s2=np.zeros((0, 3)),
            temperature_deg_c=np.zeros(0),
        )
