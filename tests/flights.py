"""Short simulated flights."""

from recorded import recorded

from hostkit.recordings import Recording
from hostkit.simulation import SensorErrors


def flight(seed: int = 1, duration_s: float = 8.0) -> Recording:
    return recorded("free", seed=seed, duration_s=duration_s, errors=SensorErrors())
