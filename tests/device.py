"""A device in Python: the integer model behind a MAVLink encoder."""

import numpy as np

from hostkit.design_file import digest
from hostkit.dialect import python_module
from hostkit.filters import FILTERS
from hostkit.records import AXES, FilterDesign

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
            messages.append(
                m.MAVLink_tilt_sample_message(
                    k * 10_000,
                    k,
                    int(states[k, 0]),
                    int(states[k, 1]),
                    accel[k].tolist(),
                    gyro[k].tolist(),
                    0,
                    0,
                    list(bytes.fromhex(self.digest)),
                    int(k == 0) | flags,
                    states[k, 2:].tolist(),
                )
            )
        return [self._pack(message) for message in messages]

    def _pack(self, message) -> bytes:
        frame = bytes(message.pack(self.mav))
        self.mav.seq = (self.mav.seq + 1) % 256
        return frame
