"""A comparison as the JSON document ``hostkit.compare/1``."""

import math

from hostkit.comparison.comparison import Comparison
from hostkit.comparison.cost import Cost
from hostkit.comparison.row import Row
from hostkit.design_file import digest
from hostkit.units import DEG_PER_RAD

COMPARE_SCHEMA = "hostkit.compare/1"


def to_document(comparison: Comparison, costs: tuple[Cost, ...]) -> dict[str, object]:
    """Return a comparison and what a sample costs as one document; what is not known is null."""
    design = comparison.design
    return {
        "schema": COMPARE_SCHEMA,
        "quantity": comparison.quantity,
        "recordings": list(comparison.recordings),
        "samples": comparison.samples,
        "design": None if design is None else digest(design),
        "trained_on": comparison.trained_on,
        "lead_ms": comparison.lead_s * 1e3,
        "calibrated_peers": comparison.calibrated_peers,
        "filters": [_row(row) for row in comparison.rows],
        "missing": [{"name": one.name, "reason": one.reason} for one in comparison.missing],
        "costs": [
            {
                "name": cost.name,
                "title": cost.title,
                "timed": cost.timed,
                "ns_per_sample": cost.ns_per_sample,
                "reason": cost.reason,
            }
            for cost in costs
        ],
    }


def _row(row: Row) -> dict[str, object]:
    held_out = row.held_out
    return {
        "name": row.name,
        "title": row.title,
        "origin": row.origin,
        "settings": row.settings,
        "offline": row.is_offline,
        "gyro_scale_tuned": row.is_scaled,
        "lead_ms": row.lead_s * 1e3,
        "rmse_deg": _degrees(row.mean_rad),
        "worst_rmse_deg": _degrees(row.worst_rad),
        "each_rmse_deg": [_degrees(value) for value in row.each_rad],
        "held_out": None
        if held_out is None
        else {
            "unit": held_out.unit,
            "folds": held_out.folds,
            "rmse_deg": _degrees(held_out.rms_rad),
            "worst_rmse_deg": _degrees(row.honest_worst_rad),
            "each_rmse_deg": [_degrees(value) for value in held_out.each_rad],
        },
        "evaluations": row.evaluations,
        "parameters": [{"name": p.name, "value": p.value, "unit": p.unit} for p in row.parameters],
    }


def _degrees(value_rad: float) -> float | None:
    return value_rad * DEG_PER_RAD if math.isfinite(value_rad) else None
