"""A device whose parameters were set runs, bit for bit, the design that it tells of."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from boards import Heard, stimulus
from designs import design
from ground import Ground, values

from hostkit.filters.complementary import (
    lower,
    run_integer,
    step_integer,
    told_by_device,
    with_told,
)
from hostkit.records import FilterDesign

RETUNED = 4
NAMES = ("FILT_TAU", "GYRO_BIAS_ROLL", "GYRO_BIAS_PITCH", "TILT_OFS_ROLL", "TILT_OFS_PITCH")
SET = (("FILT_TAU", 0.7), ("GYRO_BIAS_PITCH", 0.011), ("TILT_OFS_ROLL", -0.02))


def run_by(heard: Heard) -> FilterDesign:
    """Return the design that a device runs after what it has told."""
    told = dict(values(heard))
    own = told_by_device(design())
    given = tuple(told.get(name, mine) for name, mine in zip(NAMES, own, strict=True))
    return with_told(design(), given)


def states(heard: Heard) -> tuple[np.ndarray, np.ndarray]:
    """Return the states that came, and those of the integer model of the design that was told."""
    samples = heard.samples
    accel, gyro = (np.array([getattr(s, name) for s in samples]) for name in ("accel", "gyro"))
    came = np.array([[s.roll, s.pitch] for s in samples])
    return came, run_integer(lower(run_by(heard)), accel, gyro)


def test_what_is_set_holds_from_the_sample_behind_its_value(host_folder: Path) -> None:
    ground = Ground()
    for name, value in SET:
        ground.set(1.0, name, value)
    heard = ground.run(host_folder, stimulus(300))
    names = [frame.name for frame in heard.frames]
    before = names[: names.index("PARAM_VALUE")].count("TILT_SAMPLE")
    samples = heard.samples
    assert 0 < before < 300
    assert [bool(s.flags & RETUNED) for s in samples] == [k >= before for k in range(300)]
    spec, own = lower(run_by(heard)), lower(design())
    state = np.array([samples[before - 1].roll, samples[before - 1].pitch], dtype=np.int64)
    for k, sample in enumerate(samples[before:]):
        accel, gyro = np.array([sample.accel]), np.array([sample.gyro])
        state = step_integer(spec, state[None], accel, gyro)[0]
        assert [sample.roll, sample.pitch] == state.tolist(), f"{k} samples behind the value"
    assert spec != own


def test_what_is_stored_is_what_the_filter_runs_after_a_restart(host_folder: Path) -> None:
    first, second = Ground(), Ground()
    for i, (name, value) in enumerate(SET):
        first.set(0.5 + 0.1 * i, name, value)
        second.read(0.5 + 0.1 * i, name)
    store = first.board_run(host_folder, stimulus(600)).store
    feels = replace(stimulus(200), store=store)
    heard = second.run(host_folder, feels)
    assert {name for name, _ in values(heard)} == {name for name, _ in SET}
    assert all(s.flags & RETUNED for s in heard.samples)
    came, wanted = states(heard)
    np.testing.assert_array_equal(came, wanted)
