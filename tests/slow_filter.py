"""A filter whose state is longer than a sample's message and hardly seen in its angles."""

from dataclasses import replace
from typing import Any

import numpy as np
from designs import design
from device import COLUMN, Device

from hostkit.filters import FILTERS
from hostkit.filters.arctan import arctan_table
from hostkit.filters.filter import DeviceParameter, Fact, Filter, RunTime
from hostkit.fixedpoint import wrap32
from hostkit.mounting import Mounting
from hostkit.records import AXES, FilterDesign, Parameter
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import Counts, to_rate_and_force_g
from hostkit.spec import FixedPointSpec, StateWord
from hostkit.units import RAD_PER_HALF_TURN_LSB

NAME = "slow"
STATE_ID = 52051
WORDS = ("rate_sum", "count", "yaw_sum", "force_sum", "mixed", "last")
PLACE = {"SLOW_GAIN": "gain", "SLOW_BIAS": "bias"}


def lower(of: FilterDesign) -> FixedPointSpec:
    """The parameters hide in the words' worth, so that the spec needs no class of its own."""
    words = [StateWord(name=name, unit="1", per_unit=1.0) for name in WORDS]
    words.append(StateWord(name="gain", unit="1", per_unit=of.parameter("gain")))
    words.append(StateWord(name="bias", unit="1", per_unit=of.parameter("bias")))
    return FixedPointSpec(
        filter=NAME,
        axes=AXES[of.axes],
        mounting=Mounting.parse("+x+y+z"),
        arctan=arctan_table(),
        gravity_count=16384,
        hidden=tuple(words),
        error_bound_rad=0.0,
        error_per_closed_sample_rad=0.0,
    )


def _run(gain: float, bias: float, axes: int, accel: Any, gyro: Any, start: Any) -> np.ndarray:
    """The rate's sum shows in the angle a 256th; the other words never do."""
    hidden = np.zeros(8) if start is None else np.asarray(start)[axes:]
    begin = 0 if start is None else hidden[1] + 1
    rate_sum = hidden[0] + np.cumsum(gyro[:, 0] - bias)
    words = np.zeros((len(accel), 8))
    words[:, 0] = rate_sum
    words[:, 1] = begin + np.arange(len(accel))
    words[:, 2] = hidden[2] + np.cumsum(gyro[:, 2])
    words[:, 3] = hidden[3] + np.cumsum(gain * accel[:, 2])
    words[:, 4] = words[:, 3] * 3 + words[:, 2]
    words[:, 5] = accel[:, 0]
    angles = [accel[:, 1] * 1000 + rate_sum / 256, accel[:, 0] * 500 - rate_sum / 256]
    return np.column_stack((*angles[:axes], words))


def run_integer(spec: FixedPointSpec, accel: Any, gyro: Any, start: Any = None) -> np.ndarray:
    gain, bias = (word.per_unit for word in spec.hidden[-2:])
    states = _run(gain, bias, len(spec.axes), accel, gyro, start)
    return wrap32(np.floor(states).astype(np.int64))


def run_float(of: FilterDesign, rate: Any, force: Any, start: Any = None) -> np.ndarray:
    part, one = SENSORS[of.sensor.part], np.ones((1, 3), dtype=np.int64)
    per_count = to_rate_and_force_g(part, of.sensor, Counts(accel=one, gyro=one))
    axes = len(AXES[of.axes])
    gain, bias = of.parameter("gain"), of.parameter("bias")
    counts = np.round(force / per_count[1]), np.round(rate / per_count[0])
    states = _run(gain, bias, axes, *counts, start)
    states[:, :axes] *= RAD_PER_HALF_TURN_LSB
    return states


def device_parameters(of: FilterDesign) -> tuple[DeviceParameter, ...]:
    return tuple(
        DeviceParameter(
            name=name, unit="1", design_value=of.parameter(own), lowest=1.0, highest=64.0
        )
        for name, own in PLACE.items()
    )


def with_told(of: FilterDesign, values: Any) -> FilterDesign:
    changed = {PLACE[name]: value for name, value in values.items()}
    return replace(
        of,
        parameters=tuple(replace(p, value=changed.get(p.name, p.value)) for p in of.parameters),
    )


def _unused(*_: object) -> Any:
    raise NotImplementedError


FILTER_FACTS = (Fact(name="gain", label="gain", value=2.0),)


def slow_filter() -> Filter[FixedPointSpec]:
    parts = dict.fromkeys(Filter.__dataclass_fields__, _unused)
    parts |= {
        "name": NAME,
        "title": "slow filter",
        "lower": lower,
        "run_float": run_float,
        "run_integer": run_integer,
        "run_time": RunTime(known=(), parameters=device_parameters, with_told=with_told),
        "facts": lambda of: FILTER_FACTS,
    }
    return Filter(**parts)


def register(monkeypatch: Any) -> None:
    monkeypatch.setitem(FILTERS._parts, NAME, slow_filter())


def slow_design(*, axes: str = "both", gain: float = 2.0, bias: float = 7.0) -> FilterDesign:
    values = {"bias": bias, "gain": gain}
    parameters = tuple(Parameter(name=n, value=v, unit="1") for n, v in values.items())
    return replace(design(axes=axes), filter=NAME, parameters=parameters)


class SlowDevice(Device):
    """Tells its state behind every so many-th sample, the first one left out."""

    def __init__(self, of: FilterDesign, *, seed: int = 1, every: int = 50) -> None:
        super().__init__(of, seed=seed)
        self.every = every

    def counts(self, samples: int) -> tuple[np.ndarray, np.ndarray]:
        return tuple(kind // 64 for kind in super().counts(samples))

    def run(
        self,
        samples: int,
        *,
        changes: dict[int, dict[str, float]] | None = None,
        restarts: tuple[int, ...] = (),
        upset: dict[int, tuple[int, int]] | None = None,
    ) -> list[bytes]:
        """Frames of a run.

        Parameters
        ----------
        changes
            Parameters that are told, and used, from a sample on.
        restarts
            Samples with which the filter begins anew.
        upset
            Word and bit of the state that turns over in the device after a sample, by sample.
        """
        accel, gyro = self.counts(samples)
        told = {p.name: p.design_value for p in device_parameters(self.design)}
        own, used, state = dict(told), self.design, None
        frames = []
        for k in range(samples):
            for name, value in (changes or {}).get(k, {}).items():
                told[name] = value
                frames.append(self.told(name, value))
                used = with_told(self.design, told)
            one, anew = slice(k, k + 1), k == 0 or k in restarts
            state = run_integer(lower(used), accel[one], gyro[one], None if anew else state)[0]
            axes = len(AXES[self.design.axes])
            if k in (upset or {}):
                word, bit = upset[k]
                state[axes + word] ^= 1 << bit
            frames.append(self.sample_frame(k, state[:axes], accel[k], gyro[k], anew, told != own))
            if k and k % self.every == 0:
                frames.append(self.state_frame(k, state[axes:].tolist()))
        return frames

    def sample_frame(self, k, angles, accel, gyro, anew, retuned) -> bytes:
        words = np.zeros(4, dtype=np.int64)
        words[[COLUMN[axis] for axis in AXES[self.design.axes]]] = angles
        return self._pack(self._sample(k, words, accel, gyro, int(anew) | 4 * retuned))

    def state_frame(self, k: int, words: list[int]) -> bytes:
        words = [*words, *[0] * (24 - len(words))]
        return self._pack(self.module.MAVLink_tilt_state_message(k, words))


def is_state(frame: bytes) -> bool:
    return frame[7:10] == STATE_ID.to_bytes(3, "little")
