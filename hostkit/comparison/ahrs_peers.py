"""Filters of the package ahrs, which are in Python.

References
----------
R. Mahony, T. Hamel, J.-M. Pflimlin, "Nonlinear complementary filters on the special orthogonal
group", IEEE Transactions on Automatic Control 53(5), 2008, pp. 1203-1218.
S. O. H. Madgwick, A. J. L. Harrison, R. Vaidyanathan, "Estimation of IMU and MARG orientation using
a gradient descent algorithm", IEEE ICORR 2011.
R. G. Valenti, I. Dryanovski, J. Xiao, "Keeping a good attitude: a quaternion-based orientation
filter for IMUs and MARGs", Sensors 15(8), 2015, pp. 19302-19330.
"""

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from hostkit.comparison.peer import Peer, PeerParameter, package

Vector = NDArray[np.float64]

SLOWNESS: Final = 50
TIMED: Final = "Python"


def _run(
    form: str,
    rate_rad_s: Vector,
    force_m_s2: Vector,
    period_s: float,
    named: dict[str, float],
    is_inverse: bool = False,
) -> Vector:
    filters: Any = package("ahrs.filters", form)
    found = getattr(filters, form)(
        gyr=rate_rad_s, acc=force_m_s2, frequency=1.0 / period_s, **named
    )
    quaternions = np.asarray(found.Q, dtype=np.float64)
    return quaternions * [1.0, -1.0, -1.0, -1.0] if is_inverse else quaternions


def run_mahony(
    rate_rad_s: Vector, force_m_s2: Vector, period_s: float, values: tuple[float, ...]
) -> Vector:
    """Run Mahony's filter with bias."""
    return _run("Mahony", rate_rad_s, force_m_s2, period_s, {"k_P": values[0], "k_I": values[1]})


def run_madgwick(
    rate_rad_s: Vector, force_m_s2: Vector, period_s: float, values: tuple[float, ...]
) -> Vector:
    """Run Madgwick's filter of 2011."""
    return _run("Madgwick", rate_rad_s, force_m_s2, period_s, {"gain": values[0]})


def run_aqua(
    rate_rad_s: Vector, force_m_s2: Vector, period_s: float, values: tuple[float, ...]
) -> Vector:
    """Run AQUA, whose orientation is that of the earth in the sensor's axes."""
    return _run("AQUA", rate_rad_s, force_m_s2, period_s, {"alpha": values[0]}, is_inverse=True)


AHRS_PEERS: Final = (
    Peer(
        name="mahony",
        title="Mahony (ahrs)",
        package="ahrs",
        parameters=(
            PeerParameter(name="k_P", unit="1/s", default=1.0, lowest=0.02, highest=5.0),
            PeerParameter(name="k_I", unit="1/s^2", default=0.3, lowest=1e-4, highest=1.0),
        ),
        run=run_mahony,
        slowness=SLOWNESS,
        timed=TIMED,
    ),
    Peer(
        name="madgwick",
        title="Madgwick (ahrs)",
        package="ahrs",
        parameters=(
            PeerParameter(name="gain", unit="rad/s", default=0.033, lowest=1e-3, highest=0.5),
        ),
        run=run_madgwick,
        slowness=SLOWNESS,
        timed=TIMED,
    ),
    Peer(
        name="aqua",
        title="AQUA (ahrs)",
        package="ahrs",
        parameters=(PeerParameter(name="alpha", unit="1", default=0.01, lowest=1e-4, highest=0.2),),
        run=run_aqua,
        slowness=SLOWNESS,
        timed=TIMED,
    ),
)
