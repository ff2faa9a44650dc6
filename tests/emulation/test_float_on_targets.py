"""The filter in floats on every board, against the float model on the counts that were sent."""

from pathlib import Path

import numpy as np
import pytest
from boards import RESTARTED, TARGET_TOOLS, hear, require_or_skip, stimulus
from designs import all_parameters
from ground import Ground

from hostkit.emulation import avr_board, host_board, rp2040_board, stm32_board
from hostkit.filters.complementary import lower, run_float
from hostkit.render import generate, write
from hostkit.render.options import FirmwareOptions
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import Counts, to_rate_and_force_g
from hostkit.targets import TARGETS

DESIGN = all_parameters()
BOARDS = {
    "host": host_board,
    "atmega328p": avr_board,
    "rp2040": rp2040_board,
    "stm32f103": stm32_board,
}
TOLERANCE_DEG = 1.5e-3


@pytest.mark.parametrize("target", BOARDS)
def test_it_follows_the_float_model(tmp_path: Path, target: str) -> None:
    require_or_skip(*TARGET_TOOLS[target])
    if target == "stm32f103":
        pytest.importorskip("unicorn")
    write(generate(DESIGN, TARGETS[target], FirmwareOptions(arithmetic="float")), tmp_path)
    BOARDS[target].build(tmp_path)
    samples = hear(BOARDS[target].run(tmp_path, stimulus(300, DESIGN))).samples
    assert len(samples) == 300
    both = Counts(
        accel=np.array([s.accel for s in samples]), gyro=np.array([s.gyro for s in samples])
    )
    wanted = run_float(DESIGN, *to_rate_and_force_g(SENSORS["mpu6050"], DESIGN.sensor, both))
    got = np.array([[s.roll, s.pitch, *s.hidden] for s in samples]) * lower(DESIGN).state_per_unit
    apart = np.abs((got - wanted + np.pi) % (2.0 * np.pi) - np.pi)
    assert 0.0 < np.degrees(apart[:, :2].max()) < TOLERANCE_DEG
    assert apart[:, 2:].max() < 1e-5


def test_a_bias_starts_the_filter_with_an_integral_anew(tmp_path: Path) -> None:
    require_or_skip(*TARGET_TOOLS["host"])
    write(generate(DESIGN, TARGETS["host"], FirmwareOptions(arithmetic="float")), tmp_path)
    host_board.build(tmp_path)
    ground = Ground()
    ground.set(0.5, "FILT_TAU", 2.0)
    ground.set(1.0, "GYRO_BIAS_PITCH", 0.01)
    samples = ground.run(tmp_path, stimulus(150, DESIGN)).samples
    first, again = (s.sequence for s in samples if s.flags & RESTARTED)
    assert (first, 0 < again < 150) == (0, True)
