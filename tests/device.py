"""A device in Python: the integer model behind a MAVLink encoder."""

import numpy as np

from hostkit.design_file import digest
from hostkit.dialect import python_module
from hostkit.filters import FILTERS
from hostkit.records import AXES, FilterDesign
from hostkit.validation import device_parameters

COLUMN = {"roll": 0, "pitch": 1}


class Device:
    def __init__(self, design: FilterDesign, *, seed: int = 1) -> None:
        self.design = design
        self.digest = digest(design)
        self.module = python_module()
        self.mav = self.module.MAVLink(None, srcSystem=1, srcComponent=1)
        self.seed = seed

    def counts(self, samples: int) -> tuple[np.ndarray, np.ndarray]:
        rng = np.random.default_rng(self.seed)
        t = np.arange(samples) / self.design.rate_hz
        accel = np.stack([3000 * np.sin(t), 9000 * np.sin(3 * t), 13000 + 0 * t], axis=1)
        gyro = np.stack([2000 * np.cos(3 * t), -500 * np.cos(t), 0 * t], axis=1)
        noise = rng.normal(0, 40, (2, samples, 3))
        return tuple(np.round(np.stack([accel, gyro]) + noise).astype(np.int64))

    def states(self, samples: int) -> np.ndarray:
        """Roll, pitch and the two hidden words, as TILT_SAMPLE has them."""
        filter_, axes = FILTERS[self.design.filter], AXES[self.design.axes]
        state = filter_.run_integer(filter_.lower(self.design), *self.counts(samples))
        out = np.zeros((samples, 4), dtype=np.int64)
        for i, axis in enumerate(axes):
            out[:, COLUMN[axis]] = state[:, i]
        hidden = state[:, len(axes) :]
        out[:, 2 : 2 + hidden.shape[1]] = hidden
        return out

    def frames(
        self, samples: int, *, states: np.ndarray | None = None, flags: int = 0
    ) -> list[bytes]:
        """One heartbeat, then a sample each, with gapless frame numbers."""
        m = self.module
        accel, gyro = self.counts(samples)
        states = self.states(samples) if states is None else states
        messages = [m.MAVLink_heartbeat_message(0, 0, 0, 0, 4, 3)]
        for k in range(samples):
            flags_k = int(k == 0) | flags
            messages.append(self._sample(k, states[k], accel[k], gyro[k], flags_k))
        return [self._pack(message) for message in messages]

    def retuned_frames(self, samples: int, changes: dict[int, dict[str, float]]) -> list[bytes]:
        """Samples, and before some of them the parameters that are in use from there on."""
        told = {p.name: p.design_value for p in device_parameters(self.design)}
        own, used = dict(told), self.design
        filter_, axes = FILTERS[self.design.filter], len(AXES[self.design.axes])
        accel, gyro = self.counts(samples)
        frames, state = [], None
        for k in range(samples):
            restarts = k == 0
            for name, value in changes.get(k, {}).items():
                restarts |= "BIAS" in name and filter_.lower(self.design).integral is not None
                told[name] = float(np.float32(value))
                frames.append(self.told(name, told[name]))
            if k in changes:
                used = filter_.run_time.with_told(self.design, told)
            spec, one = filter_.lower(used), slice(k, k + 1)
            if restarts:
                state = filter_.run_integer(spec, accel[one], gyro[one])
            else:
                state = filter_.step_integer(spec, state, accel[one], gyro[one])
            words = np.zeros(4, dtype=np.int64)
            for i, axis in enumerate(AXES[self.design.axes]):
                words[COLUMN[axis]] = state[0, i]
            words[2 : 2 + state.shape[1] - axes] = state[0, axes:]
            flags = int(restarts) | (4 if told != own else 0)
            frames.append(self._pack(self._sample(k, words, accel[k], gyro[k], flags)))
        return frames

    def told(self, name: str, value: float) -> bytes:
        """A PARAM_VALUE."""
        m = self.module
        return self._pack(m.MAVLink_param_value_message(name.encode(), value, 9, 7, 0))

    def _sample(self, k, state, accel, gyro, flags):
        return self.module.MAVLink_tilt_sample_message(
            k * 10_000,
            k,
            int(state[0]),
            int(state[1]),
            accel.tolist(),
            gyro.tolist(),
            0,
            0,
            list(bytes.fromhex(self.digest)),
            flags,
            state[2:].tolist(),
        )

    def _pack(self, message) -> bytes:
        frame = bytes(message.pack(self.mav))
        self.mav.seq = (self.mav.seq + 1) % 256
        return frame
