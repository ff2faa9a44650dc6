"""The peers' C, on the host and on the emulated AVR, against the same filters in NumPy."""

from pathlib import Path

import numpy as np
import pytest
from boards import changed, hear, require_or_skip
from designs import design

from benchmarks.device_cost import CONTENDERS, Contender, code, wild_motion
from benchmarks.peer_models import MODELS
from hostkit.emulation import avr_board
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import Counts, to_rate_and_force_g
from hostkit.units import RAD_PER_HALF_TURN_LSB

DESIGN = design()
PEERS = tuple(one for one in CONTENDERS if one.peer)
TOLERANCE_DEG = 0.001
"""Measured on the host: up to 0.0002 deg."""


def swinging(samples: int = 2000) -> np.ndarray:
    """Counts of a body that rolls and pitches, with a bias and with noise, shape ``(N, 6)``."""
    t = np.arange(samples) / DESIGN.rate_hz
    roll, pitch = 2.5 * np.sin(0.7 * t), 0.8 * np.sin(1.1 * t)
    force = [-np.sin(pitch), np.sin(roll) * np.cos(pitch), np.cos(roll) * np.cos(pitch)]
    roll_rate, pitch_rate = 2.5 * 0.7 * np.cos(0.7 * t), 0.8 * 1.1 * np.cos(1.1 * t)
    body = [
        roll_rate,
        pitch_rate * np.cos(roll),
        -pitch_rate * np.sin(roll),
    ]
    rates = np.degrees(np.stack(body, axis=1)) * 65.5 + (60.0, -90.0, 20.0)
    counts = np.hstack([16384.0 * np.stack(force, axis=1), rates])
    noise = np.random.default_rng(8).normal(0.0, 60.0, counts.shape)
    return np.clip(np.round(counts + noise), -32768, 32767).astype(np.int64)


def modelled(peer: str, counts: np.ndarray) -> np.ndarray:
    both = Counts(accel=counts[:, :3], gyro=counts[:, 3:])
    inputs = to_rate_and_force_g(SENSORS["mpu6050"], DESIGN.sensor, both)
    return MODELS[peer](*inputs, DESIGN.period_s)


def apart_deg(units: np.ndarray, wanted: np.ndarray) -> float:
    found = units * RAD_PER_HALF_TURN_LSB
    return float(np.degrees(np.abs((found - wanted + np.pi) % (2 * np.pi) - np.pi).max()))


def built(host_cc, one: Contender, folder: Path, *fault: str) -> Path:
    code(one, "host", DESIGN, folder)
    if fault:
        changed(folder / f"{one.peer}.c", *fault)
    sources = (folder / "hk_filter.c", folder / f"{one.peer}.c")
    harness = Path(__file__).with_name("peer_main.c")
    return host_cc.build(folder / "peer", f"-I{folder}", harness, *sources, "-lm")


@pytest.mark.parametrize("one", PEERS, ids=lambda one: one.peer)
def test_a_peer_equals_its_model(host_cc, one: Contender, tmp_path: Path) -> None:
    program = built(host_cc, one, tmp_path)
    got = np.array(host_cc.run(program, swinging().tolist()), dtype=np.int64)
    assert apart_deg(got, modelled(one.peer, swinging())) < TOLERANCE_DEG
    assert np.ptp(got[:, 0]) * RAD_PER_HALF_TURN_LSB > 3.0


@pytest.mark.parametrize(
    ("peer", "old", "new"),
    [
        ("madgwick", "- 4.0f * q[2] * f[2]", "- 2.0f * q[2] * f[2]"),
        ("madgwick", "BETA 0.1f", "BETA 0.11f"),
        ("mahony", "bias[i] -= INTEGRAL", "bias[i] += INTEGRAL"),
        ("mahony", "PROPORTIONAL 1.0f", "PROPORTIONAL 1.1f"),
        ("kalman", "- 2.0f * s->p01", "- s->p01"),
        ("kalman", "wrapped(tilt - s->angle)", "0.9f * wrapped(tilt - s->angle)"),
    ],
)
def test_a_fault_is_found(host_cc, tmp_path: Path, peer: str, old: str, new: str) -> None:
    one = next(one for one in PEERS if one.peer == peer)
    program = built(host_cc, one, tmp_path, old, new)
    got = np.array(host_cc.run(program, swinging().tolist()), dtype=np.int64)
    assert apart_deg(got, modelled(peer, swinging())) > TOLERANCE_DEG


def test_the_peer_that_is_measured_on_a_board_is_that_peer(tmp_path: Path) -> None:
    require_or_skip("make", "avr-gcc", "node", "avr8js", "clang", "wasm-ld")
    one = next(one for one in PEERS if one.peer == "kalman")
    code(one, "atmega328p", DESIGN, tmp_path)
    avr_board.build(tmp_path)
    samples = hear(avr_board.run(tmp_path, wild_motion(DESIGN))).samples
    counts = np.array([[*s.accel, *s.gyro] for s in samples])
    got = np.array([[s.roll, s.pitch] for s in samples])
    assert len(samples) > 300
    assert apart_deg(got, modelled("kalman", counts)) < TOLERANCE_DEG
