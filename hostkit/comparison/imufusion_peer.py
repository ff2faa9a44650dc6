"""The filter of x-io's Fusion, by its Python package.

References
----------
S. O. H. Madgwick, "AHRS algorithms and calibration solutions to facilitate new applications using
low-cost MEMS", PhD thesis, University of Bristol, 2014, chapter 7.
"""

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from hostkit.comparison.peer import Peer, PeerParameter, package
from hostkit.units import DEG_PER_RAD, STANDARD_GRAVITY_M_S2

Vector = NDArray[np.float64]

PARAMETERS: Final = (
    PeerParameter(name="gain", unit="1", default=0.5, lowest=0.005, highest=2.0),
    PeerParameter(
        name="acceleration_rejection",
        unit="deg",
        default=0.0,
        lowest=0.0,
        highest=40.0,
        is_log=False,
    ),
    PeerParameter(
        name="rejection_timeout", unit="s", default=0.0, lowest=0.0, highest=20.0, is_log=False
    ),
    PeerParameter(
        name="stationary_threshold",
        unit="deg/s",
        default=0.0,
        lowest=0.0,
        highest=8.0,
        is_log=False,
    ),
)
"""The last one is of the package's bias estimate, which its default does without: 0."""


def run_fusion(
    rate_rad_s: Vector, force_m_s2: Vector, period_s: float, values: tuple[float, ...]
) -> Vector:
    """Run Fusion sample by sample, which is the only way that its package has."""
    module: Any = package("imufusion", "AhrsSettings")
    gain, rejection_deg, timeout_s, stationary_deg_s = values
    rate_hz = 1.0 / period_s
    filter_ = module.Ahrs()
    filter_.set_settings(
        module.AhrsSettings(
            sample_rate=rate_hz,
            gain=gain,
            acceleration_rejection=rejection_deg,
            rejection_timeout=timeout_s,
        )
    )
    rate_deg_s = np.ascontiguousarray(rate_rad_s * DEG_PER_RAD)
    force_g = np.ascontiguousarray(force_m_s2 / STANDARD_GRAVITY_M_S2)
    if stationary_deg_s > 0.0:
        rate_deg_s = _unbiased(module, rate_deg_s, rate_hz, stationary_deg_s)
    quaternions = np.empty((len(rate_deg_s), 4))
    for k, (rate, force) in enumerate(zip(rate_deg_s, force_g, strict=True)):
        filter_.update_no_magnetometer(rate, force)
        quaternions[k] = filter_.get_quaternion()
    return quaternions


def _unbiased(module: Any, rate_deg_s: Vector, rate_hz: float, threshold_deg_s: float) -> Vector:
    bias = module.Bias()
    bias.set_settings(
        module.BiasSettings(sample_rate=rate_hz, stationary_threshold=threshold_deg_s)
    )
    return np.array([bias.update(rate) for rate in rate_deg_s])


FUSION_PEER: Final = Peer(
    name="imufusion",
    title="Fusion (x-io)",
    package="imufusion",
    parameters=PARAMETERS,
    run=run_fusion,
    slowness=6,
    timed="C, called from Python sample by sample",
)
