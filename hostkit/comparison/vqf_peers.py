"""VQF in its three forms.

References
----------
D. Laidig, T. Seel, "VQF: highly accurate IMU orientation estimation with bias estimation and
magnetic disturbance rejection", Information Fusion 91, 2023, pp. 187-204.
"""

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from hostkit.comparison.peer import Peer, PeerParameter, package

Vector = NDArray[np.float64]

TAU: Final = PeerParameter(name="tauAcc", unit="s", default=3.0, lowest=0.1, highest=30.0)
PARAMETERS: Final = (
    TAU,
    PeerParameter(name="biasSigmaMotion", unit="deg/s", default=0.1, lowest=0.01, highest=2.0),
    PeerParameter(name="biasForgettingTime", unit="s", default=100.0, lowest=5.0, highest=1000.0),
    PeerParameter(name="restThGyr", unit="deg/s", default=2.0, lowest=0.2, highest=10.0),
    PeerParameter(name="restThAcc", unit="m/s^2", default=0.5, lowest=0.05, highest=3.0),
)


def _named(values: tuple[float, ...]) -> dict[str, float]:
    return {p.name: value for p, value in zip(PARAMETERS, values, strict=False)}


def _batch(
    form: str, rate_rad_s: Vector, force_m_s2: Vector, period_s: float, values: tuple[float, ...]
) -> Vector:
    filter_: Any = getattr(package("vqf", form), form)(period_s, **_named(values))
    found = filter_.updateBatch(rate_rad_s, force_m_s2)
    return np.asarray(found["quat6D"])


def run_online(
    rate_rad_s: Vector, force_m_s2: Vector, period_s: float, values: tuple[float, ...]
) -> Vector:
    """Run VQF sample by sample."""
    return _batch("VQF", rate_rad_s, force_m_s2, period_s, values)


def run_basic(
    rate_rad_s: Vector, force_m_s2: Vector, period_s: float, values: tuple[float, ...]
) -> Vector:
    """Run BasicVQF, which estimates no bias."""
    return _batch("BasicVQF", rate_rad_s, force_m_s2, period_s, values)


def run_offline(
    rate_rad_s: Vector, force_m_s2: Vector, period_s: float, values: tuple[float, ...]
) -> Vector:
    """Run offline VQF over the whole recording."""
    smoother: Any = package("vqf", "offlineVQF").offlineVQF
    found = smoother(rate_rad_s, force_m_s2, None, period_s, params=_named(values))
    return np.asarray(found["quat6D"])


VQF_PEERS: Final = (
    Peer(
        name="vqf-online",
        title="VQF",
        package="vqf",
        parameters=PARAMETERS,
        run=run_online,
        timed="C++, updateBatch",
    ),
    Peer(
        name="vqf-basic",
        title="BasicVQF",
        package="vqf",
        parameters=(TAU,),
        run=run_basic,
        timed="C++, updateBatch",
    ),
    Peer(
        name="vqf-offline",
        title="VQF offline",
        package="vqf",
        parameters=PARAMETERS,
        run=run_offline,
        slowness=5,
        is_offline=True,
        timed="C++, whole recording",
    ),
)
