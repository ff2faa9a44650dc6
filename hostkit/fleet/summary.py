"""The summary of a fleet: the document ``hostkit.fleet/1``."""

import json

from hostkit.fleet.records import STATUSES, DeviceResult, FleetResult

SCHEMA = "hostkit.fleet/1"
SUMMARY = "fleet.json"


def fleet_document(result: FleetResult) -> dict[str, object]:
    """Return a fleet as plain JSON values: no time, no path of this machine."""
    return {
        "schema": SCHEMA,
        **{status: len(result.of(status)) for status in STATUSES},
        "devices": [_device(device, result.fact_names) for device in result.devices],
    }


def _device(device: DeviceResult, fact_names: tuple[str, ...]) -> dict[str, object]:
    facts = {fact.name: fact.value for fact in device.facts}
    return {
        "device": device.device,
        "status": device.status,
        "recordings": device.recordings,
        "digest": device.digest,
        **{name: facts.get(name) for name in fact_names},
        "rmse_deg": device.rmse_deg,
        "error": device.error or None,
    }


def fleet_text(result: FleetResult) -> str:
    """Return the text of ``fleet.json``; the same result gives the same bytes."""
    return json.dumps(fleet_document(result), indent=2, allow_nan=False) + "\n"
