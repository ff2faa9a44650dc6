"""How an emulated run is judged, on a board that sends what the test makes it send."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from designs import design
from device import Device

from hostkit.emulation import run as running
from hostkit.emulation.board import BoardRun, Stimulus
from hostkit.emulation.comparison import EmulationResult
from hostkit.emulation.fault import parse_fault
from hostkit.errors import EmulationError
from hostkit.filters import FILTERS
from hostkit.recordings import Recording
from hostkit.render import DEFAULT_OPTIONS, FirmwareOptions, MessageRate, generate, write
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import Counts, to_rate_and_force_g
from hostkit.targets import TARGETS
from hostkit.units import RAD_PER_HALF_TURN_LSB

DESIGN, HOST = design(), TARGETS["host"]
SAMPLES = 100
LSB_RAD = RAD_PER_HALF_TURN_LSB
Frames = Callable[[Device], list[bytes]]


@dataclass
class Scripted:
    """A board that sends prepared frames."""

    frames: list[bytes]

    def run(self, folder: Path, stimulus: Stimulus, *, progress=None) -> BoardRun:
        return BoardRun(stream=b"".join(self.frames))


def recording(device: Device) -> Recording:
    accel, gyro = device.counts(SAMPLES)
    part = SENSORS["mpu6050"]
    rate, force_g = to_rate_and_force_g(part, DESIGN.sensor, Counts(accel=accel, gyro=gyro))
    return Recording(
        name="device",
        rate_hz=DESIGN.rate_hz,
        time_s=np.arange(SAMPLES) / DESIGN.rate_hz,
        angular_rate_rad_s=rate,
        specific_force_m_s2=force_g * 9.80665,
        valid=np.ones(SAMPLES, dtype=np.bool_),
    )


@pytest.fixture
def judge(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    def call(
        frames: Frames, options: FirmwareOptions = DEFAULT_OPTIONS, *faults: str
    ) -> EmulationResult:
        device = Device(DESIGN)
        write(generate(DESIGN, HOST, options), tmp_path)
        monkeypatch.setitem(running.BOARDS, "host", Scripted(frames(device)))
        planned = tuple(parse_fault(text) for text in faults)
        return running.emulate(tmp_path, HOST, DESIGN, recording(device), faults=planned)

    return call


def decimated(hz: float) -> FirmwareOptions:
    return FirmwareOptions(message_rates=(MessageRate(name="TILT_SAMPLE", rate_hz=hz),))


def every_4th(device: Device) -> list[bytes]:
    return device.frames(SAMPLES)[1::4]


def in_double(device: Device, error_rad: float = 0.0) -> list[bytes]:
    """The float model's angles, as a device in float sends them."""
    accel, gyro = device.counts(SAMPLES)
    counts = Counts(accel=accel, gyro=gyro)
    si = to_rate_and_force_g(SENSORS["mpu6050"], DESIGN.sensor, counts)
    angles = FILTERS[DESIGN.filter].run_float(DESIGN, *si)[:, :2]
    states = np.zeros((SAMPLES, 4), dtype=np.int64)
    states[:, :2] = np.round((angles + error_rad) / LSB_RAD)
    return device.frames(SAMPLES, states=states)


def retuned(device: Device) -> list[bytes]:
    m, frames = device.module, device.frames(SAMPLES)
    parser = m.MAVLink(None)
    out = []
    for k, frame in enumerate(frames):
        message = parser.decode(bytearray(frame))
        if k > 10:
            message.flags |= running.RETUNED
        out.append(bytes(message.pack(device.mav)))
    return out


def test_every_sample_equal_is_passed(judge) -> None:
    result = judge(lambda device: device.frames(SAMPLES))
    assert (result.samples, result.missing, result.mismatches) == (SAMPLES, 0, 0)
    assert result.passed
    assert result.tolerance_rad is None


def test_decimated_samples_are_held_against_their_own_rows(judge) -> None:
    result = judge(every_4th, decimated(25.0))
    assert (result.samples, result.missing, result.mismatches) == (25, 0, 0)
    assert result.passed


def test_decimated_samples_of_a_firmware_that_was_to_send_all_are_missing(judge) -> None:
    result = judge(every_4th)
    assert (result.missing, result.passed) == (75, False)


def test_the_wrong_rows_are_missing(judge) -> None:
    result = judge(lambda device: device.frames(SAMPLES)[2::4], decimated(25.0))
    assert (result.samples, result.missing, result.mismatches) == (25, 25, 0)


def test_a_lost_and_a_wrong_decimated_sample_show(judge) -> None:
    def spoilt(device: Device) -> list[bytes]:
        states = device.states(SAMPLES)
        states[8, 0] += 1
        frames = device.frames(SAMPLES, states=states)[1::4]
        return frames[:5] + frames[6:]

    result = judge(spoilt, decimated(25.0))
    assert (result.missing, result.mismatches, result.passed) == (1, 1, False)


@pytest.mark.parametrize(("error_rad", "beyond"), [(0.0, 0), (0.6e-5, 0), (1.1e-5, SAMPLES)])
def test_float_arithmetic_has_a_tolerance(judge, error_rad: float, beyond: int) -> None:
    """Both angles are off; the direction of up is by both together."""
    options = FirmwareOptions(arithmetic="float")
    result = judge(lambda device: in_double(device, error_rad), options)
    assert (result.mismatches, result.tolerance_rad) == (beyond, 1e-5)
    assert result.passed is (beyond == 0)


def test_float_angles_do_not_pass_for_the_integer_model(judge) -> None:
    assert judge(in_double).mismatches > 0


def test_wrong_counts_are_wrong_in_float_too(judge) -> None:
    def spoilt(device: Device) -> list[bytes]:
        frames = in_double(device)
        other = in_double(Device(DESIGN, seed=2))
        return [*frames[:50], other[50], *frames[51:]]

    assert judge(spoilt, FirmwareOptions(arithmetic="float")).mismatches == 1


def test_a_device_with_other_parameters_is_not_judged(judge) -> None:
    with pytest.raises(EmulationError, match=r"other parameters .* in 90 of 100 samples"):
        judge(retuned)


def test_without_samples_there_is_nothing_to_judge(judge) -> None:
    with pytest.raises(EmulationError, match="TILT_SAMPLE is off"):
        judge(lambda device: device.frames(SAMPLES), decimated(0.0))


def test_faults_need_every_sample(judge) -> None:
    with pytest.raises(EmulationError, match=r"every 4th sample.* TILT_SAMPLE=100"):
        judge(every_4th, decimated(25.0), "self-reset@0.5")


def test_a_run_with_faults_has_the_tolerance_too(judge) -> None:
    options = FirmwareOptions(arithmetic="float")
    good = judge(in_double, options, "nack-address@0.5")
    bad = judge(lambda device: in_double(device, 2e-5), options, "nack-address@0.5")
    assert (good.mismatches, bad.mismatches) == (0, SAMPLES)
    assert replace(good, mismatches=0).tolerance_rad == 1e-5
