"""From a diagnosis on disk to the errors of a simulated sensor."""

import json
import math
from dataclasses import dataclass, replace
from pathlib import Path

from hostkit.diagnosis.allan import OptionalTriple
from hostkit.diagnosis.document import ALLAN_SCHEMA, DIAGNOSE_SCHEMA
from hostkit.errors import HostkitError
from hostkit.simulation import SensorErrors
from hostkit.simulation.sensor_errors import Triple
from hostkit.units import RAD_PER_DEG

SIZE_LIMIT_BYTES = 100_000_000
LARGEST = 1e6
"""No bias or noise in any of the units here is beyond this."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MeasuredErrors:
    """What a diagnosis says of a sensor.

    Attributes
    ----------
    recording
        Name of the recording that it was measured on.
    errors
        Gyroscope bias, its walk and the noise densities as measured; the rest, which a sensor at
        rest does not show, as it is by default.
    remarks
        What was not seen in the recording, and what stands in its place.
    """

    recording: str
    errors: SensorErrors
    remarks: tuple[str, ...]


def load_measured_errors(path: Path) -> MeasuredErrors:
    """Read the noise of a sensor from a document of ``hostkit diagnose``.

    Parameters
    ----------
    path
        What ``--allan-out`` wrote, or what ``--json`` printed.

    Raises
    ------
    HostkitError
        If it is no such document, or not exactly one of its recordings has noise in it.
    """
    try:
        return _measured(_document(path))
    except HostkitError as error:
        raise HostkitError(f"{path}: {error}") from error


def _document(path: Path) -> object:
    try:
        if path.stat().st_size > SIZE_LIMIT_BYTES:
            raise HostkitError(f"it is larger than {SIZE_LIMIT_BYTES} bytes: not a diagnosis")
        document: object = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise HostkitError(f"it cannot be read: {error.strerror}") from error
    except (ValueError, RecursionError) as error:
        raise HostkitError(f"it is not JSON: {str(error)[:200]}") from error
    return document


def _measured(document: object) -> MeasuredErrors:
    schema = _entry(document, "schema", "the document")
    if schema not in (DIAGNOSE_SCHEMA, ALLAN_SCHEMA):
        raise HostkitError(
            f"schema is {schema!r:.60}; it must be {DIAGNOSE_SCHEMA} or {ALLAN_SCHEMA}"
        )
    recordings = _entry(document, "recordings", "the document")
    if not isinstance(recordings, list):
        raise HostkitError(f"recordings is {recordings!r:.60}; it must be a list")
    noisy = [r for r in recordings if _entry(r, "noise", "a recording") is not None]
    if len(noisy) != 1:
        raise HostkitError(
            f"{len(noisy)} of its {len(recordings)} recording(s) have noise figures; exactly one "
            "must: diagnose one recording with 30 s of rest or more"
        )
    noise = _entry(noisy[0], "noise", "a recording")
    return _errors(str(_entry(noisy[0], "name", "a recording")), noise)


def _errors(recording: str, noise: object) -> MeasuredErrors:
    gyro, accel = _entry(noise, "gyro", "noise"), _entry(noise, "accel", "noise")
    bias = _whole(_triple(gyro, "bias_deg_s", -LARGEST), "bias_deg_s")
    rate, rate_remark = _filled(_triple(gyro, "noise_density_deg_s_rthz", 0.0), "gyroscope")
    force, force_remark = _filled(_triple(accel, "noise_density_m_s2_rthz", 0.0), "accelerometer")
    seen = _triple(gyro, "bias_walk_deg_s_rts", 0.0)
    errors = replace(
        SensorErrors(),
        gyro_bias_rad_s=_radians(bias),
        gyro_bias_walk_rad_s_rts=_radians(_zero_filled(seen)),
        gyro_noise_density_rad_s_rthz=None if rate is None else _radians(rate),
        accel_noise_density_m_s2_rthz=force,
    )
    remarks = [text for text in (rate_remark, force_remark, _walk_remark(seen)) if text]
    return MeasuredErrors(recording=recording, errors=errors, remarks=tuple(remarks))


def _filled(values: OptionalTriple, element: str) -> tuple[Triple | None, str]:
    """Give axes whose density was not seen the largest of the others."""
    seen = [value for value in values if value is not None]
    if not seen:
        return None, f"no noise density of the {element} was seen: the data sheet's is taken"
    x, y, z = (max(seen) if value is None else value for value in values)
    missing = [name for name, value in zip("xyz", values, strict=True) if value is None]
    if not missing:
        return (x, y, z), ""
    return (x, y, z), (
        f"no noise density of {element} {' and '.join(missing)} was seen: the largest of the "
        "other axes is taken"
    )


def _walk_remark(seen: OptionalTriple) -> str:
    missing = [name for name, value in zip("xyz", seen, strict=True) if value is None]
    if not missing:
        return ""
    return f"no walk of the gyroscope bias was seen on {', '.join(missing)}: none is simulated"


def _zero_filled(values: OptionalTriple) -> Triple:
    x, y, z = (value or 0.0 for value in values)
    return x, y, z


def _radians(degrees: Triple) -> Triple:
    x, y, z = (value * RAD_PER_DEG for value in degrees)
    return x, y, z


def _whole(values: OptionalTriple, key: str) -> Triple:
    x, y, z = values
    if x is None or y is None or z is None:
        raise HostkitError(f"{key} has a null; it must be three numbers")
    return x, y, z


def _triple(holder: object, key: str, least: float) -> OptionalTriple:
    values = _entry(holder, key, "noise")
    if not isinstance(values, list) or len(values) != 3:
        raise HostkitError(f"{key} is {values!r:.60}; it must be a list of three")
    x, y, z = (_number(value, key, least) for value in values)
    return x, y, z


def _number(value: object, key: str, least: float) -> float | None:
    if value is None:
        return None
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise HostkitError(f"{key} has {value!r:.60}; it must be a finite number or null")
    if not least <= value <= LARGEST:
        raise HostkitError(f"{key} has {value:g}; the limits are {least:g} and {LARGEST:g}")
    return float(value)


def _entry(holder: object, key: str, where: str) -> object:
    if not isinstance(holder, dict) or key not in holder:
        raise HostkitError(f"{where} lacks the key {key!r}; is it a document of hostkit diagnose?")
    value: object = holder[key]
    return value
