"""The peers themselves, where they are installed, on a short simulated flight."""

import math

import numpy as np
import pytest
from flights import flight
from recorded import SENSOR

from hostkit.comparison import PEERS, CompareOptions, costs
from hostkit.comparison.calibration import readings_of
from hostkit.comparison.problem import PeerProblem
from hostkit.mounting import Mounting
from hostkit.records import FilterDesign
from hostkit.tuning import TUNERS


@pytest.mark.parametrize("name", PEERS.names())
def test_a_peer_finds_up_in_our_axes(name):
    peer = PEERS[name]
    pytest.importorskip(peer.package)
    problem = PeerProblem(
        peer=peer,
        readings=(readings_of(flight()),),
        quantity="inclination",
        mounting=Mounting(),
        lead_s=0.0,
    )
    # Wrong axes or a wrong frame make tens of degrees of this motion.
    assert math.degrees(problem.each_rms_rad(peer.defaults)[0]) < 8.0


@pytest.mark.parametrize("name", ["vqf-online", "imufusion", "madgwick", "mahony", "aqua"])
def test_parameters_reach_the_package(name):
    peer = PEERS[name]
    pytest.importorskip(peer.package)
    one = readings_of(flight(duration_s=4.0))
    for i, parameter in enumerate(peer.parameters):
        values = list(peer.defaults)
        values[i] = parameter.lowest if parameter.is_log else parameter.highest
        known = peer.run(one.rate_rad_s, one.force_m_s2, one.period_s, peer.defaults)
        other = peer.run(one.rate_rad_s, one.force_m_s2, one.period_s, tuple(values))
        assert known.shape == other.shape == (len(one.track), 4)
        if i == 0:
            assert np.abs(known - other).max() > 1e-4, parameter.name


def test_cost_of_our_c_and_of_a_peer():
    pytest.importorskip("vqf")
    recording = flight()
    design = FilterDesign(
        filter="observer",
        axes="both",
        tilt="atan2",
        mounting=Mounting(),
        rate_hz=recording.rate_hz,
        sensor=SENSOR,
        parameters=TUNERS["observer"].default(),
    )
    found = costs(recording, CompareOptions(design=design, peers=("vqf-online",)))
    timed = {(c.name, c.timed): c.ns_per_sample for c in found}
    ours = timed["observer", "generated C, fixed point, update"]
    assert ours is not None
    assert 0.0 < ours < timed["vqf-online", "C++, updateBatch"]
