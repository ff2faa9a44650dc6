"""The design file: canonical JSON, strict reading, and the digest that names a design.

The digest is the first 12 hex digits of the SHA-256 of the canonical JSON without its ``digest``
key. It is always computed from the content, so a design that somebody edited is another design,
and a device that runs the old one is refused. What a device must keep to pass, ``acceptance``, is
not part of it: other limits make no other device.
"""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import asdict, fields, replace
from pathlib import Path
from typing import Any

from hostkit.errors import DesignError
from hostkit.files import write_aside
from hostkit.json_object import JsonObject
from hostkit.mounting import Mounting
from hostkit.provenance import TERM_UNITS, CalibrationRecord, CalibrationTerm, TermKind
from hostkit.records import (
    AXES,
    OBJECTIVES,
    TILT_METHODS,
    Acceptance,
    FilterDesign,
    Parameter,
    RecordingDigest,
    SensorConfig,
    TuningRecord,
)

SCHEMA = "hostkit.design/1"
DIGEST_HEX_DIGITS = 12
SIZE_LIMIT_BYTES = 16 * 2**20


def to_document(design: FilterDesign) -> dict[str, Any]:
    """Return what the digest of a design is taken of, as plain JSON values."""
    document: dict[str, Any] = {
        "schema": SCHEMA,
        "filter": design.filter,
        "axes": design.axes,
        "tilt": design.tilt,
        "mounting": str(design.mounting),
        "rate_hz": design.rate_hz,
        "sensor": asdict(design.sensor),
        "parameters": {p.name: {"value": p.value, "unit": p.unit} for p in design.parameters},
        "tuning": None if design.tuning is None else _tuning_document(design.tuning),
    }
    if design.calibration is not None:
        document["calibration"] = _calibration_document(design.calibration)
    return document


def _calibration_document(record: CalibrationRecord) -> dict[str, Any]:
    document = {key: value for key, value in asdict(record).items() if value is not None}
    document["terms"] = {
        term.name: {
            "value": term.value,
            "standard_error": term.standard_error,
            "unit": TERM_UNITS[term.kind],
        }
        for term in record.terms
    }
    document["recordings"] = [asdict(recording) for recording in record.recordings]
    return document


def _tuning_document(tuning: TuningRecord) -> dict[str, Any]:
    document = asdict(tuning)
    document["versions"] = dict(tuning.versions)
    document["recordings"] = [asdict(recording) for recording in tuning.recordings]
    if tuning.held_out_rmse_deg is None:
        del document["held_out_rmse_deg"]
    return document


def canonical_json(document: Mapping[str, Any]) -> str:
    """Return the one text of a document: sorted keys, no spaces, ASCII, shortest floats."""
    return json.dumps(document, sort_keys=True, separators=(",", ":"), allow_nan=False)


def digest(design: FilterDesign) -> str:
    """Return the 12 hex digits that name a design."""
    text = canonical_json(to_document(design))
    return hashlib.sha256(text.encode("ascii")).hexdigest()[:DIGEST_HEX_DIGITS]


def save_design(design: FilterDesign, path: Path) -> None:
    """Write a design file, aside and then renamed.

    Raises
    ------
    HostkitError
        If the file cannot be written.
    """
    write_aside(path, design_text(design))


def design_text(design: FilterDesign) -> str:
    """Return the text of a design file: the canonical content, indented, with its digest."""
    document = {**to_document(design), "digest": digest(design)}
    if design.acceptance is not None:
        limits = asdict(design.acceptance)
        document["acceptance"] = {k: v for k, v in limits.items() if v is not None}
    return json.dumps(document, sort_keys=True, indent=2, allow_nan=False) + "\n"


def load_design(path: Path) -> FilterDesign:
    """Read a design file.

    Raises
    ------
    DesignError
        If the file is not readable, not JSON, of another schema, or has a key that is missing,
        unknown, of the wrong type or out of range. The message names the key.
    """
    try:
        if path.stat().st_size > SIZE_LIMIT_BYTES:
            raise DesignError(f"{path} is larger than {SIZE_LIMIT_BYTES} bytes: not a design file")
        document = json.loads(path.read_text(encoding="utf-8"), parse_constant=_refuse_constant)
    except OSError as error:
        raise DesignError(f"{path} cannot be read: {error.strerror}") from error
    except (ValueError, RecursionError) as error:
        raise DesignError(f"{path} is not JSON: {str(error)[:200]}") from error
    try:
        return from_document(document)
    except DesignError as error:
        raise DesignError(f"{path}: {error}") from error


def with_acceptance_of(design: FilterDesign, path: Path) -> FilterDesign:
    """Return a design with the limits of the one that a file has now, if there is one."""
    if not path.is_file():
        return design
    try:
        return replace(design, acceptance=load_design(path).acceptance)
    except DesignError:
        return design


def edited_by_hand(path: Path) -> bool:
    """Tell whether the digest written in a design file is not that of its content."""
    written = json.loads(path.read_text(encoding="utf-8")).get("digest")
    return written is not None and written != digest(load_design(path))


def _refuse_constant(name: str) -> None:
    raise ValueError(f"{name} is not a number a design may hold")


def from_document(document: object) -> FilterDesign:
    """Return the design of a parsed design file.

    Raises
    ------
    DesignError
        If anything in it is not as the schema says.
    """
    top = JsonObject(document, "design")
    if top.text("schema") != SCHEMA:
        raise DesignError(f"schema is {top.text('schema')!r}; this hostkit reads {SCHEMA!r}")
    top.only(
        "schema digest filter axes tilt mounting rate_hz sensor parameters tuning acceptance "
        "calibration"
    )
    sensor = top.inner("sensor")
    sensor.only("part gyro_full_scale_deg_s accel_full_scale_g low_pass_setting")
    return FilterDesign(
        filter=top.name("filter"),
        axes=top.choice("axes", tuple(AXES)),
        tilt=top.choice("tilt", TILT_METHODS),
        mounting=Mounting.parse(top.text("mounting")),
        rate_hz=top.number("rate_hz"),
        sensor=SensorConfig(
            part=sensor.name("part"),
            gyro_full_scale_deg_s=sensor.integer("gyro_full_scale_deg_s"),
            accel_full_scale_g=sensor.integer("accel_full_scale_g"),
            low_pass_setting=sensor.integer("low_pass_setting"),
        ),
        parameters=_parameters(top.inner("parameters")),
        tuning=None if top.value("tuning") is None else _tuning(top.inner("tuning")),
        acceptance=_acceptance(top.inner("acceptance")) if top.has("acceptance") else None,
        calibration=_calibration(top.inner("calibration")) if top.has("calibration") else None,
    )


def _acceptance(reader: JsonObject) -> Acceptance:
    names = tuple(item.name for item in fields(Acceptance))
    reader.only(" ".join(names))
    return Acceptance(**{name: reader.optional_number(name) for name in names})


def _parameters(reader: JsonObject) -> tuple[Parameter, ...]:
    found = []
    for name in sorted(reader.keys()):
        if not name.isidentifier() or not name.isascii():
            raise DesignError(f"parameters: {name!r} is not a name (letters, digits, underscores)")
        entry = reader.inner(name)
        entry.only("value unit")
        found.append(Parameter(name=name, value=entry.number("value"), unit=entry.text("unit")))
    return tuple(found)


def _tuning(reader: JsonObject) -> TuningRecord:
    reader.only(
        "objective optimiser seed particles iterations evaluations rmse_deg held_out_rmse_deg "
        "recordings versions"
    )
    versions = reader.inner("versions")
    return TuningRecord(
        objective=reader.choice("objective", OBJECTIVES),
        optimiser=reader.name("optimiser"),
        seed=reader.integer("seed"),
        particles=reader.integer("particles"),
        iterations=reader.integer("iterations"),
        evaluations=reader.integer("evaluations"),
        rmse_deg=reader.number("rmse_deg"),
        recordings=tuple(_recording(r) for r in reader.items("recordings")),
        versions=tuple((name, versions.text(name)) for name in sorted(versions.keys())),
        held_out_rmse_deg=reader.optional_number("held_out_rmse_deg"),
    )


def _recording(reader: JsonObject) -> RecordingDigest:
    reader.only("name sha256 samples")
    return RecordingDigest(
        name=reader.text("name"), sha256=reader.text("sha256"), samples=reader.integer("samples")
    )


def _calibration(reader: JsonObject) -> CalibrationRecord:
    reader.only(" ".join(item.name for item in fields(CalibrationRecord)))
    return CalibrationRecord(
        gravity_m_s2=reader.number("gravity_m_s2"),
        poses=reader.integer("poses"),
        turns=reader.integer("turns"),
        terms=_terms(reader.inner("terms")),
        recordings=tuple(_recording(r) for r in reader.items("recordings")),
        temperature_c=reader.optional_number("temperature_c"),
        temperature_low_c=reader.optional_number("temperature_low_c"),
        temperature_high_c=reader.optional_number("temperature_high_c"),
        force_before_m_s2=reader.optional_number("force_before_m_s2"),
        force_after_m_s2=reader.optional_number("force_after_m_s2"),
        turn_before_deg=reader.optional_number("turn_before_deg"),
        turn_after_deg=reader.optional_number("turn_after_deg"),
    )


def _terms(reader: JsonObject) -> tuple[CalibrationTerm, ...]:
    """Return the terms of a calibration in the order of their kinds."""
    reader.only(" ".join(f"{kind}_{axis}" for kind in TERM_UNITS for axis in "xyz"))
    return tuple(
        _term(reader.inner(f"{kind}_{name}"), kind, axis)
        for kind in TERM_UNITS
        for axis, name in enumerate("xyz")
        if reader.has(f"{kind}_{name}")
    )


def _term(reader: JsonObject, kind: TermKind, axis: int) -> CalibrationTerm:
    reader.only("value standard_error unit")
    reader.choice("unit", (TERM_UNITS[kind],))
    return CalibrationTerm(
        kind=kind,
        axis=axis,
        value=reader.number("value"),
        standard_error=reader.number("standard_error"),
    )
