"""What a recording shows of its sensor and its motion."""

from hostkit.diagnosis.diagnosis import Diagnosis, diagnose
from hostkit.diagnosis.document import allan_document, to_document
from hostkit.diagnosis.findings import Finding, findings
from hostkit.diagnosis.measured_errors import MeasuredErrors, load_measured_errors
from hostkit.diagnosis.noise import SensorNoise, sensor_noise
from hostkit.diagnosis.planarity import Planarity, Verdict

__all__ = [
    "Diagnosis",
    "Finding",
    "MeasuredErrors",
    "Planarity",
    "SensorNoise",
    "Verdict",
    "allan_document",
    "diagnose",
    "findings",
    "load_measured_errors",
    "sensor_noise",
    "to_document",
]
