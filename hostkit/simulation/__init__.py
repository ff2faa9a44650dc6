"""Simulation: recordings from motion profiles and a model of the sensor."""

from hostkit.simulation.profiles import PROFILES, Profile, at_rest
from hostkit.simulation.sensor_errors import SensorErrors
from hostkit.simulation.simulator import simulate

__all__ = ["PROFILES", "Profile", "SensorErrors", "at_rest", "simulate"]
