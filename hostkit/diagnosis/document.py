"""A diagnosis as the JSON document ``hostkit.diagnose/1``, and the noise in it as one of its own.

Angles are in degrees, forces in m/s^2, what could not be found is null. Both documents have a list
``recordings`` whose entries have ``path``, ``name`` and ``noise``, and either is read by
`hostkit.diagnosis.measured_errors`.
"""

from dataclasses import asdict
from pathlib import Path

from hostkit.diagnosis.allan import AllanCurve, OptionalTriple
from hostkit.diagnosis.clipping import Clipping
from hostkit.diagnosis.diagnosis import Diagnosis
from hostkit.diagnosis.findings import findings
from hostkit.diagnosis.force import PERCENTILES, VIBRATION_FROM_HZ, ForceLevel
from hostkit.diagnosis.noise import SensorNoise
from hostkit.diagnosis.planarity import Planarity
from hostkit.diagnosis.recommendation import recommended_filter
from hostkit.diagnosis.rest import Rest
from hostkit.diagnosis.timing import Timing
from hostkit.units import DEG_PER_RAD, STANDARD_GRAVITY_M_S2

DIAGNOSE_SCHEMA = "hostkit.diagnose/1"
ALLAN_SCHEMA = "hostkit.allan/1"


def to_document(diagnoses: tuple[tuple[Path, Diagnosis], ...]) -> dict[str, object]:
    """Return diagnoses, each with the path of its recording, as one document."""
    return {
        "schema": DIAGNOSE_SCHEMA,
        "recordings": [_recording(path, diagnosis) for path, diagnosis in diagnoses],
    }


def allan_document(diagnoses: tuple[tuple[Path, Diagnosis], ...]) -> dict[str, object]:
    """Return only the noise of diagnoses, as one document."""
    return {
        "schema": ALLAN_SCHEMA,
        "recordings": [
            {"path": str(path), "name": d.name, "noise": _noise(d.noise)} for path, d in diagnoses
        ],
    }


def _recording(path: Path, diagnosis: Diagnosis) -> dict[str, object]:
    span = diagnosis.temperature_deg_c
    recommended = recommended_filter(diagnosis)
    return {
        "path": str(path),
        "name": diagnosis.name,
        "samples": diagnosis.samples,
        "rate_hz": diagnosis.rate_hz,
        "duration_s": diagnosis.duration_s,
        "axes": diagnosis.axes,
        "mounting": str(diagnosis.mounting),
        "findings": [asdict(finding) for finding in findings(diagnosis)],
        "time": _timing(diagnosis.timing),
        "range": {
            "largest_deg_s": [v * DEG_PER_RAD for v in diagnosis.reach.largest_rad_s],
            "largest_g": [v / STANDARD_GRAVITY_M_S2 for v in diagnosis.reach.largest_m_s2],
            "clipped": [_clipping(clipping) for clipping in diagnosis.reach.clippings],
        },
        "rest": _rest(diagnosis.rest),
        "temperature_deg_c": None if span is None else list(span),
        "force": _force(diagnosis.force),
        "motion": _motion(diagnosis.planarity),
        "recommended_filter": recommended and recommended.filter,
        "recommended_because": recommended and recommended.reason,
        "noise": _noise(diagnosis.noise),
    }


def _timing(timing: Timing) -> dict[str, object]:
    return {
        "least_step_s": timing.least_s,
        "median_step_s": timing.median_s,
        "longest_step_s": timing.most_s,
        "jitter_rms_s": timing.jitter_s,
        "histogram": {"edges_s": timing.edges_s.tolist(), "counts": timing.counts.tolist()},
        "gap_count": timing.gap_count,
        "longest_gaps": [asdict(gap) for gap in timing.gaps],
    }


def _clipping(clipping: Clipping) -> dict[str, object]:
    is_gyro = clipping.element == "gyro"
    per_unit = DEG_PER_RAD if is_gyro else 1.0 / STANDARD_GRAVITY_M_S2
    return {
        "element": clipping.element,
        "axis": "xyz"[clipping.axis],
        "value": clipping.value * per_unit,
        "full_scale": clipping.full_scale,
        "unit": "deg/s" if is_gyro else "g",
        "share": clipping.share,
    }


def _rest(rest: Rest) -> dict[str, object]:
    return {
        "share": rest.share,
        "bias_deg_s": _degrees(rest.bias_rad_s),
        "bias_uncertainty_deg_s": _degrees(rest.bias_uncertainty_rad_s),
        "force_error": rest.force_error,
        "force_spread": rest.force_spread,
        "stretches": [
            {
                "begin_s": s.begin_s,
                "end_s": s.end_s,
                "bias_deg_s": _degrees(s.bias_rad_s),
                "force_m_s2": s.force_m_s2,
            }
            for s in rest.stretches
        ],
    }


def _force(force: ForceLevel) -> dict[str, object]:
    shares = zip(PERCENTILES, force.deviation_percentiles_g, strict=True)
    return {
        "vibration_from_hz": VIBRATION_FROM_HZ,
        "vibration_m_s2": None if force.vibration_m_s2 is None else list(force.vibration_m_s2),
        "vibration_total_m_s2": force.vibration_total_m_s2,
        "deviation_median_g": force.deviation_median_g,
        "deviation_percentiles_g": {f"{percent:g}": value for percent, value in shares},
        "histogram": {"edges_g": force.edges_g.tolist(), "counts": force.counts.tolist()},
    }


def _motion(planarity: Planarity) -> dict[str, object]:
    errors = planarity.errors
    return {
        "verdict": planarity.verdict,
        "against": planarity.tilt,
        "scored_samples": planarity.scored,
        "tau_s": planarity.errors.tau_s,
        "predicted_deg": errors.predicted_rad * DEG_PER_RAD,
        "three_dimensional_tau_s": planarity.errors.spatial_tau_s,
        "three_dimensional_deg": errors.spatial_rad * DEG_PER_RAD,
        "neglect_deg": errors.neglect_rad * DEG_PER_RAD,
        "extra_deg": errors.extra_rad * DEG_PER_RAD,
        "rate_error_deg_s": planarity.rate_error_rad_s * DEG_PER_RAD,
        "roll_spread_deg": planarity.roll_spread_rad * DEG_PER_RAD,
        "pitch_spread_deg": planarity.pitch_spread_rad * DEG_PER_RAD,
        "turn_share": list(planarity.turn_share),
    }


def _noise(noise: SensorNoise | None) -> dict[str, object] | None:
    if noise is None:
        return None
    return {
        "rate_hz": noise.rate_hz,
        "duration_s": noise.duration_s,
        "samples": noise.samples,
        "stretches": noise.stretches,
        "gyro": {
            "bias_deg_s": _degrees(noise.gyro_bias_rad_s),
            "bias_uncertainty_deg_s": _degrees(noise.gyro_bias_uncertainty_rad_s),
            **_curve(noise.gyro, "deg_s", DEG_PER_RAD),
        },
        "accel": _curve(noise.accel, "m_s2", 1.0),
    }


def _curve(curve: AllanCurve, unit: str, per_unit: float) -> dict[str, object]:
    return {
        f"noise_density_{unit}_rthz": _scaled(curve.noise_density, per_unit),
        f"white_noise_{unit}_at_1_s": _scaled(curve.white_noise, per_unit),
        f"bias_instability_{unit}": _scaled(curve.bias_instability, per_unit),
        f"bias_walk_{unit}_rts": _scaled(curve.random_walk, per_unit),
        "tau_s": curve.tau_s.tolist(),
        f"deviation_{unit}": (curve.deviation * per_unit).tolist(),
        "intervals": curve.intervals.tolist(),
    }


def _scaled(values: OptionalTriple, per_unit: float) -> list[float | None]:
    return [None if value is None else value * per_unit for value in values]


def _degrees(values: OptionalTriple | None) -> list[float | None] | None:
    return None if values is None else _scaled(values, DEG_PER_RAD)
