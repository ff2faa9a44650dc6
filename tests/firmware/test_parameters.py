"""The parameter protocol, spoken with the host firmware by pymavlink."""

from pathlib import Path

import numpy as np
import pytest
from boards import RESTARTED, Heard, copied, generated, hear, stimulus
from designs import all_parameters, design
from ground import Ground, resting, values

from hostkit.emulation import host_board
from hostkit.filters import FILTERS
from hostkit.spec import FixedPointSpec

NAMES = [
    *("SYS_ID", "CAL_START", "FILT_TAU"),
    *("GYRO_BIAS_ROLL", "TILT_OFS_ROLL", "GYRO_BIAS_PITCH", "TILT_OFS_PITCH"),
]
RETUNED = 4
FILTER = FILTERS["complementary"]
TAU_S = 0.01 * 0.9965 / 0.0035


def test_the_list_is_told_once_in_order_and_telemetry_goes_on(host_folder: Path) -> None:
    ground = Ground()
    ground.list(0.5)
    heard = ground.run(host_folder, stimulus(200))
    told = heard.of("PARAM_VALUE")
    assert [m.param_id for m in told] == NAMES
    assert [(m.param_count, m.param_index) for m in told] == [(7, i) for i in range(7)]
    assert {m.param_type for m in told} == {9}
    assert dict(values(heard))["SYS_ID"] == 1.0
    assert dict(values(heard))["FILT_TAU"] == pytest.approx(TAU_S, rel=1e-4)
    assert [s.sequence for s in heard.samples] == list(range(200))
    kinds = [f.name for f in heard.frames if f.name in ("PARAM_VALUE", "TILT_SAMPLE")]
    between = "".join(kind[0] for kind in kinds).strip("T")
    assert "PP" not in between, "samples come between the values"


@pytest.mark.parametrize("to", [(0, 0), (1, 0), (0, 1)])
def test_everybody_is_meant_too(host_folder: Path, to: tuple[int, int]) -> None:
    ground = Ground()
    ground.list(0.5, to=to)
    assert len(values(ground.run(host_folder, stimulus(150)))) == 7


@pytest.mark.parametrize("to", [(2, 1), (1, 2), (255, 190), (0, 2), (2, 0)])
def test_others_are_not_answered_for(host_folder: Path, to: tuple[int, int]) -> None:
    ground = Ground()
    ground.list(0.5, to=to)
    ground.set(0.6, "FILT_TAU", 1.0, to=to)
    ground.command(0.7, 512, 148, to=to)
    heard = ground.run(host_folder, stimulus(150))
    assert {f.name for f in heard.frames} <= {
        *("HEARTBEAT", "ATTITUDE", "TILT_SAMPLE", "SYS_STATUS")
    }


def test_one_is_read_by_name_or_by_number(host_folder: Path) -> None:
    ground = Ground()
    ground.read(0.5, "TILT_OFS_PITCH")
    ground.read(0.6, "", 2)
    ground.read(0.7, "NOT_THERE")
    ground.read(0.8, "", 7)
    ground.read(0.9, "", -2)
    assert [name for name, _ in values(ground.run(host_folder, stimulus(150)))] == [
        "TILT_OFS_PITCH",
        "FILT_TAU",
    ]


def test_the_value_that_is_told_is_the_one_in_use(host_folder: Path) -> None:
    ground = Ground()
    ground.set(0.5, "FILT_TAU", 1.2345)
    ground.read(1.0, "FILT_TAU")
    (_, first), (_, second) = values(ground.run(host_folder, stimulus(200)))
    assert first == second == pytest.approx(1.2345, rel=1e-4)


@pytest.mark.parametrize("value", [-1.0, 0.0, 1e30, float("nan"), float("inf")])
def test_out_of_range_is_answered_with_the_old_value(host_folder: Path, value: float) -> None:
    ground = Ground()
    ground.set(0.5, "FILT_TAU", value)
    heard = ground.run(host_folder, stimulus(150))
    assert values(heard) == [("FILT_TAU", pytest.approx(TAU_S, rel=1e-4))]
    assert not any(s.flags & RETUNED for s in heard.samples)


def test_a_name_of_sixteen_characters_is_not_taken_for_a_shorter_one(host_folder: Path) -> None:
    ground = Ground()
    ground.set(0.5, "FILT_TAU" + "\0" * 7 + "X", 1.0)
    ground.set(0.6, "TILT_OFS_PITCHXX", 0.1)
    ground.read(0.7, "SYS_ID" + "X" * 10)
    told = values(ground.run(host_folder, stimulus(150)))
    assert [name for name, _ in told] == ["FILT_TAU"], "what stands behind a zero is no name"


def split_at_value(heard, name: str) -> tuple[list, list]:
    """Return the samples before and behind the PARAM_VALUE of a name."""
    at = next(
        i
        for i, f in enumerate(heard.frames)
        if f.name == "PARAM_VALUE" and f.message.param_id == name
    )
    return tuple(
        [f.message for f in part if f.name == "TILT_SAMPLE"]
        for part in (heard.frames[:at], heard.frames[at:])
    )


def wrong_steps(samples: list, spec: FixedPointSpec) -> int:
    """Count the steps that are not the integer model's, each from the angles before it."""
    accel, gyro = (np.array([getattr(s, name) for s in samples[1:]]) for name in ("accel", "gyro"))
    angles = np.array([[s.roll, s.pitch] for s in samples])
    wanted = FILTER.step_integer(spec, angles[:-1], accel, gyro)
    return int((wanted != angles[1:]).any(axis=1).sum())


def test_a_sample_is_made_with_the_value_told_before_it(host_folder: Path) -> None:
    """The integer model, switched at the PARAM_VALUE, gives every angle of the stream."""
    tau_s = 0.5
    ground = Ground()
    ground.set(1.0, "FILT_TAU", tau_s)
    heard = ground.run(host_folder, stimulus(300))
    before, behind = split_at_value(heard, "FILT_TAU")
    assert len(before) > 40
    assert len(behind) > 100
    assert not any(s.flags & RETUNED for s in before)
    assert all(s.flags & RETUNED for s in behind)
    told = dict(values(heard))["FILT_TAU"]
    old, new = (FILTER.lower(d) for d in (design(), design(eta=told / (told + 0.01))))
    assert old.blend != new.blend
    assert wrong_steps(before, old) == 0
    assert wrong_steps([before[-1], *behind], new) == 0
    assert wrong_steps([before[-1], *behind], old) > 100


def test_no_sample_is_told_behind_a_value_that_it_was_not_made_with(
    host_folder: Path, tmp_path: Path
) -> None:
    """On a link that is full most of the time samples wait, and values must wait for them."""
    folder = copied(host_folder, tmp_path / "code")
    full = "return board.now_ns / 1000000U % 7U < 2U ? UINT8_MAX : 20U;"
    text = (folder / "hk_hal_host.c").read_text(encoding="ascii")
    assert text.count("return UINT8_MAX;") == 1
    (folder / "hk_hal_host.c").write_text(text.replace("return UINT8_MAX;", full), encoding="ascii")
    host_board.build(folder, sanitize=True)
    ground = Ground()
    own = values(_told(host_folder))[0][1]
    for i in range(60):
        ground.set(0.5 + 0.023 * i, "FILT_TAU", 1.0 if i % 2 == 0 else own)
    retuned, checked = False, 0
    for frame in ground.run(folder, stimulus(250)).frames:
        if frame.name == "PARAM_VALUE":
            retuned = frame.message.param_value != own
        elif frame.name == "TILT_SAMPLE":
            assert bool(frame.message.flags & RETUNED) == retuned, frame.message.sequence
            checked += retuned
    assert checked > 20


def _told(folder: Path) -> Heard:
    ground = Ground()
    ground.read(0.5, "FILT_TAU")
    return ground.run(folder, stimulus(100))


def test_a_bias_restarts_the_filter_that_follows_it(tmp_path: Path) -> None:
    folder = generated("host", tmp_path / "code", all_parameters())
    host_board.build(folder, sanitize=True)
    ground = Ground()
    ground.set(1.0, "GYRO_BIAS_ROLL", 0.01)
    heard = ground.run(folder, stimulus(200, all_parameters()))
    before, behind = split_at_value(heard, "GYRO_BIAS_ROLL")
    assert [bool(s.flags & RESTARTED) for s in before] == [True] + [False] * (len(before) - 1)
    assert [bool(s.flags & RESTARTED) for s in behind] == [True] + [False] * (len(behind) - 1)


def test_only_the_design_s_axes_have_parameters(tmp_path: Path) -> None:
    folder = generated("host", tmp_path / "code", design(axes="pitch"))
    host_board.build(folder)
    ground = Ground()
    ground.list(0.5)
    ground.set(0.9, "GYRO_BIAS_ROLL", 0.01)
    heard = ground.run(folder, stimulus(150, design(axes="pitch")))
    assert [name for name, _ in values(heard)] == [
        *("SYS_ID", "CAL_START", "FILT_TAU", "GYRO_BIAS_PITCH", "TILT_OFS_PITCH")
    ]


def test_the_system_id_changes_with_the_next_start(host_folder: Path) -> None:
    ground = Ground()
    ground.set(0.5, "SYS_ID", 42)
    ground.set(0.6, "SYS_ID", 250)
    ground.set(0.7, "SYS_ID", 255)
    first = ground.board_run(host_folder, resting(600))
    heard = hear(first)
    assert values(heard) == [("SYS_ID", 42.0)] * 3
    assert {f.source for f in heard.frames} == {(1, 1)}
    second = Ground().run(host_folder, resting(50), store=first.store)
    assert {f.source for f in second.frames} == {(42, 1)}
