"""Many devices: one design each, on local cores or a cluster."""

from hostkit.fleet.cluster import ClusterWorkers
from hostkit.fleet.fleet import Watch, tune_fleet
from hostkit.fleet.local import LocalWorkers
from hostkit.fleet.records import (
    GROUP_RULES,
    DeviceResult,
    FleetOptions,
    FleetResult,
    GroupBy,
    SensorWish,
    Step,
)
from hostkit.fleet.summary import SUMMARY, fleet_document
from hostkit.fleet.workers import Workers

__all__ = [
    "GROUP_RULES",
    "SUMMARY",
    "ClusterWorkers",
    "DeviceResult",
    "FleetOptions",
    "FleetResult",
    "GroupBy",
    "LocalWorkers",
    "SensorWish",
    "Step",
    "Watch",
    "Workers",
    "fleet_document",
    "tune_fleet",
]
