"""The summary of a fleet: the document ``hostkit.fleet/1``."""

import json
from dataclasses import asdict

from hostkit.fleet.records import STATUSES, FleetResult

SCHEMA = "hostkit.fleet/1"
SUMMARY = "fleet.json"


def fleet_document(result: FleetResult) -> dict[str, object]:
    """Return a fleet as plain JSON values: no time, no path of this machine."""
    return {
        "schema": SCHEMA,
        **{status: len(result.of(status)) for status in STATUSES},
        "devices": [{**asdict(device), "error": device.error or None} for device in result.devices],
    }


def fleet_text(result: FleetResult) -> str:
    """Return the text of ``fleet.json``; the same result gives the same bytes."""
    return json.dumps(fleet_document(result), indent=2, allow_nan=False) + "\n"
