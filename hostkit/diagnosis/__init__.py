"""What a recording shows of its sensor and its motion."""

from hostkit.diagnosis.diagnosis import Diagnosis, diagnose
from hostkit.diagnosis.document import allan_document, to_document
from hostkit.diagnosis.findings import Finding, findings
from hostkit.diagnosis.measured_errors import MeasuredErrors, load_measured_errors
from hostkit.diagnosis.noise import SensorNoise, sensor_noise
from hostkit.diagnosis.planarity import Planarity, Verdict
from hostkit.diagnosis.recommendation import (
    Recommendation,
    recommended_filter,
    recommended_for_all,
)

__all__ = [
    "Diagnosis",
    "Finding",
    "MeasuredErrors",
    "Planarity",
    "Recommendation",
    "SensorNoise",
    "Verdict",
    "allan_document",
    "diagnose",
    "findings",
    "load_measured_errors",
    "recommended_filter",
    "recommended_for_all",
    "sensor_noise",
    "to_document",
]
