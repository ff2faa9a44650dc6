"""The design file: canonical JSON, strict reading, and the digest that names a design.

The digest is the first 12 hex digits of the SHA-256 of the canonical JSON without its ``digest``
key. It is always computed from the content, so a design that somebody edited is another design,
and a device that runs the old one is refused. What a device must keep to pass, ``acceptance``, is
not part of it: other limits make no other device.
"""

import hashlib
import json
import math
from collections.abc import Mapping
from dataclasses import asdict, fields, replace
from pathlib import Path
from typing import Any

from hostkit.errors import DesignError
from hostkit.files import write_aside
from hostkit.mounting import Mounting
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
    return {
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
    top = _Reader(document, "design")
    if top.text("schema") != SCHEMA:
        raise DesignError(f"schema is {top.text('schema')!r}; this hostkit reads {SCHEMA!r}")
    top.only("schema digest filter axes tilt mounting rate_hz sensor parameters tuning acceptance")
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
    )


def _acceptance(reader: "_Reader") -> Acceptance:
    names = tuple(item.name for item in fields(Acceptance))
    reader.only(" ".join(names))
    return Acceptance(**{name: reader.optional_number(name) for name in names})


def _parameters(reader: "_Reader") -> tuple[Parameter, ...]:
    found = []
    for name in sorted(reader.keys()):
        if not name.isidentifier() or not name.isascii():
            raise DesignError(f"parameters: {name!r} is not a name (letters, digits, underscores)")
        entry = reader.inner(name)
        entry.only("value unit")
        found.append(Parameter(name=name, value=entry.number("value"), unit=entry.text("unit")))
    return tuple(found)


def _tuning(reader: "_Reader") -> TuningRecord:
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


def _recording(reader: "_Reader") -> RecordingDigest:
    reader.only("name sha256 samples")
    return RecordingDigest(
        name=reader.text("name"), sha256=reader.text("sha256"), samples=reader.integer("samples")
    )


class _Reader:
    """A JSON object whose values are taken out by type; every refusal names the key."""

    def __init__(self, value: object, where: str) -> None:
        if not isinstance(value, dict):
            raise DesignError(f"{where} is {_shown(value)}; it must be an object")
        self._items: dict[str, object] = value
        self._where = where

    def keys(self) -> tuple[str, ...]:
        return tuple(self._items)

    def has(self, key: str) -> bool:
        return key in self._items

    def only(self, names: str) -> None:
        """Refuse keys outside `names`, a list separated by spaces."""
        unknown = sorted(set(self._items) - set(names.split()))
        if unknown:
            raise DesignError(
                f"{self._where} has the unknown key {unknown[0]!r:.80}; it may have: {names}"
            )

    def value(self, key: str) -> object:
        if key not in self._items:
            raise DesignError(f"{self._where} lacks the key {key!r}")
        return self._items[key]

    def text(self, key: str) -> str:
        value = self.value(key)
        if not isinstance(value, str) or len(value) > 1000:
            raise self._wrong(key, "a text of at most 1000 characters")
        return value

    def name(self, key: str) -> str:
        value = self.text(key)
        if not value.replace("-", "_").isidentifier() or not value.isascii():
            raise self._wrong(key, "a name of letters, digits, hyphens and underscores")
        return value

    def choice(self, key: str, choices: tuple[Any, ...]) -> Any:
        if self.value(key) not in choices:
            raise self._wrong(key, "one of " + ", ".join(choices))
        return self.value(key)

    def number(self, key: str) -> float:
        value = self.value(key)
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise self._wrong(key, "a number")
        if abs(value) > 1e18 or not math.isfinite(value):
            raise self._wrong(key, "a finite number")
        return float(value)

    def optional_number(self, key: str) -> float | None:
        return self.number(key) if key in self._items else None

    def integer(self, key: str) -> int:
        value = self.value(key)
        if isinstance(value, bool) or not isinstance(value, int) or abs(value) >= 2**63:
            raise self._wrong(key, "an integer of 64 bits")
        return value

    def inner(self, key: str) -> "_Reader":
        return _Reader(self.value(key), f"{self._where}.{key}")

    def items(self, key: str) -> tuple["_Reader", ...]:
        value = self.value(key)
        if not isinstance(value, list):
            raise self._wrong(key, "a list")
        return tuple(_Reader(v, f"{self._where}.{key}[{i}]") for i, v in enumerate(value))

    def _wrong(self, key: str, wanted: str) -> DesignError:
        shown = _shown(self._items[key])
        return DesignError(f"{self._where}.{key} is {shown}; it must be {wanted}")


def _shown(value: object) -> str:
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."
