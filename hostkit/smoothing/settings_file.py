"""The settings file of the smoother: strict JSON with where the settings come from."""

import hashlib
import json
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

from hostkit.design_file import DIGEST_HEX_DIGITS, canonical_json
from hostkit.errors import DesignError
from hostkit.files import write_aside
from hostkit.records import RecordingDigest
from hostkit.smoothing.settings import SmootherSettings

SCHEMA = "hostkit.smoother/1"
SIZE_LIMIT_BYTES = 2**20
SETTINGS = tuple(item.name for item in fields(SmootherSettings))


@dataclass(frozen=True, slots=True, kw_only=True)
class Provenance:
    """How settings were found; RMSE of the mean over recordings, held out where that was done."""

    optimiser: str
    seed: int
    evaluations: int
    rmse_deg: float
    held_out_rmse_deg: float | None
    recordings: tuple[RecordingDigest, ...]
    versions: tuple[tuple[str, str], ...]


def settings_document(
    settings: SmootherSettings, provenance: Provenance | None
) -> dict[str, object]:
    """Return a settings file as plain JSON values, with its digest."""
    training: dict[str, object] | None = None
    if provenance is not None:
        training = {**asdict(provenance), "versions": dict(provenance.versions)}
    document: dict[str, object] = {
        "schema": SCHEMA,
        "settings": asdict(settings),
        "training": training,
    }
    return {**document, "digest": _digest(document)}


def save_settings(settings: SmootherSettings, provenance: Provenance | None, path: Path) -> None:
    """Write a settings file, aside and then renamed.

    Raises
    ------
    HostkitError
        If the file cannot be written.
    """
    document = settings_document(settings, provenance)
    write_aside(path, json.dumps(document, sort_keys=True, indent=2, allow_nan=False) + "\n")


def load_settings(path: Path) -> SmootherSettings:
    """Read the settings of a settings file.

    A settings file may be written by hand: ``training`` and ``digest`` may be left out, and a
    deviation that is not there has its default.

    Raises
    ------
    DesignError
        If the file cannot be read, is not strict JSON of this schema, or holds a key or value that
        no settings have; the message names it.
    """
    try:
        if path.stat().st_size > SIZE_LIMIT_BYTES:
            raise DesignError(f"{path} is larger than {SIZE_LIMIT_BYTES} bytes: no settings file")
        document = json.loads(
            path.read_text(encoding="utf-8"),
            parse_constant=_refuse_constant,
            object_pairs_hook=_each_once,
        )
    except OSError as error:
        raise DesignError(f"{path} cannot be read: {error.strerror}") from error
    except (ValueError, RecursionError) as error:
        raise DesignError(f"{path} is not strict JSON: {str(error)[:200]}") from error
    try:
        return _settings(document)
    except DesignError as error:
        raise DesignError(f"{path}: {error}") from error


def _settings(document: object) -> SmootherSettings:
    top = _object(document, "the file", ("schema", "settings", "training", "digest"))
    if top.get("schema") != SCHEMA:
        raise DesignError(f"schema is {top.get('schema')!r:.60}; this hostkit reads {SCHEMA!r}")
    values = _object(top.get("settings"), "settings", SETTINGS)
    for name, value in values.items():
        if isinstance(value, bool) or not isinstance(value, int | float) or abs(value) > 1e18:
            raise DesignError(f"settings.{name} is {value!r:.60}; it must be a number")
    return SmootherSettings(**{name: float(value) for name, value in values.items()})


def _object(value: object, where: str, names: tuple[str, ...]) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise DesignError(f"{where} is {value!r:.60}; it must be an object")
    unknown = sorted(set(value) - set(names))
    if unknown:
        raise DesignError(
            f"{where} has the unknown key {unknown[0]!r:.80}; it may have: {', '.join(names)}"
        )
    return value


def _each_once(pairs: list[tuple[str, object]]) -> dict[str, object]:
    found = dict(pairs)
    if len(found) < len(pairs):
        raise ValueError("a key stands twice")
    return found


def _refuse_constant(name: str) -> None:
    raise ValueError(f"{name} is not a number that settings may hold")


def _digest(document: dict[str, object]) -> str:
    text = canonical_json(document)
    return hashlib.sha256(text.encode("ascii")).hexdigest()[:DIGEST_HEX_DIGITS]
