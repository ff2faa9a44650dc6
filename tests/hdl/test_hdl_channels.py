"""Several channels in one core, and settings that change between samples."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from designs import all_parameters, design, more_parameters
from hdl_cases import Core, answer, build_broken_core, build_core, count_vectors, option_vectors
from numpy.typing import NDArray

from hostkit.emulation import ghdl
from hostkit.errors import EmulationError
from hostkit.filters.complementary import lower, step_integer
from hostkit.fixedpoint import Coefficient
from hostkit.spec import FixedPointSpec

IntArray = NDArray[np.int64]

CORE = "hk_complementary_iterative.vhd"
CONSTANT = more_parameters(bias_deg_s=(1.5, -0.75), offset_deg=(2.0, -3.5))


@pytest.fixture(scope="module", params=["eta", "all", "arcsin", "roll"])
def channel_core(
    request: pytest.FixtureRequest,
    tmp_path_factory: pytest.TempPathFactory,
    ghdl_installed: None,
) -> Core:
    built = {
        "eta": design(),
        "all": all_parameters(),
        "arcsin": design(tilt="arcsin", more=CONSTANT),
        "roll": design(axes="roll"),
    }[request.param]
    return build_core(built, tmp_path_factory.mktemp("channels"))


def interleaved(samples: int, channels: int) -> IntArray:
    """Every channel by turns at first, then any."""
    rng = np.random.default_rng(channels)
    order = rng.integers(0, channels, samples)
    order[: 2 * channels] = np.tile(np.arange(channels), 2)[:samples]
    return order


def expected_of(core: Core, channel: IntArray, accel: IntArray, gyro: IntArray) -> IntArray:
    """Run the integer model on every channel by itself."""
    states = np.zeros((len(channel), 4), dtype=np.int64)
    for own in set(channel.tolist()):
        rows = channel == own
        states[rows] = core.expected(accel[rows], gyro[rows])
    return states


@pytest.mark.parametrize("channels", [1, 2, 5, 64])
@pytest.mark.parametrize("random_stalls", [False, True])
def test_every_channel_is_a_filter_of_its_own(
    channel_core: Core, channels: int, random_stalls: bool
) -> None:
    accel, gyro = (counts[:400] for counts in option_vectors(channel_core.design))
    channel = interleaved(len(accel), channels)
    run = ghdl.simulate(
        channel_core.folder,
        *(accel, gyro),
        channel=channel,
        channels=channels,
        random_stalls=random_stalls,
    )
    np.testing.assert_array_equal(run.channel, channel)
    np.testing.assert_array_equal(answer(run), expected_of(channel_core, channel, accel, gyro))
    firsts = np.zeros(len(channel), dtype=bool)
    firsts[np.unique(channel, return_index=True)[1]] = True
    np.testing.assert_array_equal(run.restarted, firsts)
    assert len(set(run.latency_cycles)) == 1


@pytest.mark.parametrize("channels", [900, 1024])
def test_900_channels_at_1_khz_take_less_than_50_mhz(
    channels: int, tmp_path: Path, ghdl_installed: None
) -> None:
    core = build_core(design(rate_hz=1000.0), tmp_path)
    accel, gyro = np.random.default_rng(channels).integers(-32768, 32768, (2, 2 * channels, 3))
    channel = np.tile(np.arange(channels), 2)
    run = ghdl.simulate(core.folder, accel, gyro, channel=channel, channels=channels)
    np.testing.assert_array_equal(run.channel, channel)
    np.testing.assert_array_equal(answer(run), expected_of(core, channel, accel, gyro))
    np.testing.assert_array_equal(run.restarted, np.arange(2 * channels) < channels)
    clocks_a_sample = np.diff(run.taken_cycle).max()
    assert 900 * 1000.0 * clocks_a_sample <= 50e6


def test_a_reset_forgets_every_channel(channel_core: Core) -> None:
    accel, gyro = (counts[:6] for counts in count_vectors())
    channel = np.arange(6) % 3
    expected = expected_of(channel_core, channel, accel, gyro)
    for clocks in (1, 40, 70, 100):
        run = ghdl.simulate(
            *(channel_core.folder, accel, gyro),
            channel=channel,
            channels=3,
            abandon_clocks=clocks,
        )
        np.testing.assert_array_equal(answer(run), expected, err_msg=f"{clocks} clocks")
        assert run.restarted.tolist() == [True] * 3 + [False] * 3


@pytest.mark.usefixtures("ghdl_installed")
@pytest.mark.parametrize(
    ("good", "bad"),
    [
        ("write   <= '1' when state_r = finished or", "write   <= '1' when"),
        ("word(0)             <= '1' when state_r = finished else '0'", "word(0) <= '1'"),
        ("restarted_r <= not stored_started;", "restarted_r <= '0';"),
        ("in_channel when state_r = idle", "channel_r when state_r = idle"),
        ("angle_next_r <= stored_angle_next", "angle_next_r <= stored_angle_now"),
    ],
    ids=["not stored", "not cleared", "no first sample", "late address", "one for two"],
)
def test_a_fault_of_the_memory_is_found(tmp_path: Path, good: str, bad: str) -> None:
    core = build_broken_core(tmp_path, source=CORE, good=good, bad=bad)
    accel, gyro = (counts[:60] for counts in count_vectors())
    channel = interleaved(60, 5)
    try:
        run = ghdl.simulate(core.folder, accel, gyro, channel=channel, channels=5)
    except EmulationError:  # values that nobody has written are unknown
        return
    assert np.any(answer(run) != expected_of(core, channel, accel, gyro))


@pytest.mark.usefixtures("ghdl_installed")
def test_mixed_up_channels_are_found(tmp_path: Path) -> None:
    good, bad = "out_channel <= channel_r when", "out_channel <= not channel_r when"
    core = build_broken_core(tmp_path, source=CORE, good=good, bad=bad)
    accel, gyro = (counts[:6] for counts in count_vectors())
    with pytest.raises(EmulationError, match="mixes up channels"):
        ghdl.simulate(core.folder, accel, gyro, channel=np.arange(6) % 2, channels=2)


def changed(spec: FixedPointSpec) -> FixedPointSpec:
    """Return a spec whose formats are the same and whose numbers are not."""

    def other(coefficient: Coefficient) -> Coefficient:
        return replace(coefficient, raw=coefficient.raw * 3 // 4 - 5)

    return replace(
        spec,
        blend=other(spec.blend),
        rate_gains=tuple(other(gain) for gain in spec.rate_gains),
        tilt_offset_raw=tuple(2**29 + 7 * i for i in range(len(spec.axes))),
        gyro_bias_raw=tuple(-(2**20) - 3 * i for i in range(len(spec.axes))),
        gate=spec.gate
        and replace(spec.gate, lowest=spec.gate.lowest - 2**24, highest=spec.gate.highest - 2**20),
        integral=spec.integral and replace(spec.integral, gain=other(spec.integral.gain)),
    )


def stepped(
    spec: FixedPointSpec, state: IntArray, accel: IntArray, gyro: IntArray
) -> Iterator[IntArray]:
    for counts in zip(accel[:, None], gyro[:, None], strict=True):
        state = step_integer(spec, state, *counts)
        yield state[0]


@pytest.mark.parametrize("random_stalls", [False, True])
def test_settings_change_between_two_samples(channel_core: Core, random_stalls: bool) -> None:
    accel, gyro = (counts[:450] for counts in option_vectors(channel_core.design))
    spec, at = lower(channel_core.design), (150, 300)
    run = ghdl.simulate(
        *(channel_core.folder, accel, gyro),
        settings={
            at[0]: ghdl.hdl_settings(channel_core.design, changed(spec)),
            at[1]: ghdl.hdl_settings(channel_core.design, spec),
        },
        random_stalls=random_stalls,
    )
    states = run.state_raw(spec)
    for first, last, used in ((150, 300, changed(spec)), (300, 450, spec)):
        state = states[first - 1 : first]
        expected = list(stepped(used, state, accel[first:last], gyro[first:last]))
        np.testing.assert_array_equal(states[first:last], expected)
    np.testing.assert_array_equal(
        answer(run)[: at[0]], channel_core.expected(accel[: at[0]], gyro[: at[0]])
    )
    assert not run.restarted[1:].any()
