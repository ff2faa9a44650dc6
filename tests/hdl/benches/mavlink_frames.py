"""Random samples for hk_mavlink_tx, and the frames that pymavlink makes of them."""

import os
import random

from hostkit.dialect import python_module

BIASES = () if "WORDS" in os.environ else ("bias_roll", "bias_pitch")
"""A core that tells its state has no ports of them."""
WIDE = ("angle_roll", "angle_pitch", *BIASES)
COUNTS = ("accel_x", "accel_y", "accel_z", "temperature", "gyro_x", "gyro_y", "gyro_z")
FLAGS = ("restarted", "saturated", "retuned")

SYSTEM, COMPONENT, VEHICLE_TYPE, AUTOPILOT = map(int, os.environ["IDENTITY"].split())


def random_sample(rng: random.Random) -> dict[str, int]:
    """Return a value for each input, often an extreme one or a small one."""
    sample = {"time_us": _unsigned(rng, 64), "sequence": _unsigned(rng, 32)}
    sample |= {name: _signed(rng, 32) for name in WIDE}
    sample |= {name: _signed(rng, 16) for name in COUNTS}
    sample |= {name: rng.randrange(2) for name in FLAGS}
    return sample | {"i2c_errors": _unsigned(rng, 16)}


def frame_of_sample(
    sample: dict[str, int], hidden_axes: tuple[str, ...], digest: bytes, number: int
) -> bytes:
    hidden = [sample[f"bias_{axis}"] for axis in hidden_axes]
    flags = sum(sample[name] << bit for bit, name in enumerate(FLAGS))
    module = python_module()
    message = module.MAVLink_tilt_sample_message(
        time_usec=sample["time_us"],
        sequence=sample["sequence"],
        roll=sample["angle_roll"],
        pitch=sample["angle_pitch"],
        accel=[sample[f"accel_{axis}"] for axis in "xyz"],
        gyro=[sample[f"gyro_{axis}"] for axis in "xyz"],
        temperature=sample["temperature"],
        i2c_errors=sample["i2c_errors"],
        digest=list(digest),
        flags=flags,
        hidden=[*hidden, 0, 0][:2],
    )
    return _packed(message, number)


def frame_of_state(sequence: int, words: list[int], number: int) -> bytes:
    padded = [*words, *([0] * (24 - len(words)))]
    message = python_module().MAVLink_tilt_state_message(sequence=sequence, words=padded)
    return _packed(message, number)


def frame_of_heartbeat(status: int, number: int) -> bytes:
    module = python_module()
    message = module.MAVLink_heartbeat_message(
        type=VEHICLE_TYPE,
        autopilot=AUTOPILOT,
        base_mode=0,
        custom_mode=0,
        system_status=status,
        mavlink_version=3,
    )
    return _packed(message, number)


def _packed(message, number: int) -> bytes:
    sender = python_module().MAVLink(None, srcSystem=SYSTEM, srcComponent=COMPONENT)
    sender.seq = number
    return bytes(message.pack(sender))


def _unsigned(rng: random.Random, bits: int) -> int:
    return rng.choice((0, 2**bits - 1, rng.randrange(256), rng.randrange(2**bits)))


def _signed(rng: random.Random, bits: int) -> int:
    half = 2 ** (bits - 1)
    return rng.choice((0, -1, -half, half - 1, rng.randrange(256), rng.randrange(-half, half)))
