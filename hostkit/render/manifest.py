"""The manifest of a generated folder: target, design, options and the hash of every file."""

import hashlib
import json
from dataclasses import asdict, dataclass, fields
from pathlib import Path, PurePosixPath
from typing import Any

from hostkit import __version__
from hostkit.design_file import digest
from hostkit.errors import RenderError
from hostkit.records import FilterDesign, GeneratedFile
from hostkit.render.choices import Options, default_options, fpga_options_of
from hostkit.render.fpga_options import FpgaOptions
from hostkit.render.fpga_report import CellCounts
from hostkit.render.options import DEFAULT_OPTIONS, FirmwareOptions, MessageRate
from hostkit.targets import TARGETS, Target

MANIFEST = "manifest.json"
MANIFEST_SCHEMA = "hostkit.manifest/1"


@dataclass(frozen=True, slots=True, kw_only=True)
class Manifest:
    """What a folder says of itself: target, design digest, options, and the hash of every file.

    Attributes
    ----------
    cells
        Resources of an FPGA, if they were measured.
    """

    target: str
    digest: str
    files: tuple[tuple[str, str], ...]
    options: Options = DEFAULT_OPTIONS
    cells: tuple[CellCounts, ...] = ()


def manifest_text(
    design: FilterDesign,
    target: Target,
    options: Options,
    files: list[GeneratedFile],
    cells: tuple[CellCounts, ...] = (),
) -> str:
    """Return the manifest of rendered files."""
    if target.kind == "fpga":
        options = fpga_options_of(target, options)
    document: dict[str, object] = {
        "schema": MANIFEST_SCHEMA,
        "hostkit": __version__,
        "target": target.name,
        "design": digest(design),
        "files": {file.path: sha256(file.content.encode("utf-8")) for file in files},
        "options": options_document(options),
    }
    if cells:
        document["cells"] = [asdict(counts) for counts in cells]
    return json.dumps(document, indent=2, sort_keys=True) + "\n"


def options_document(options: Options) -> dict[str, object]:
    """Return options as they stand in a manifest and in ``generate --json``."""
    if isinstance(options, FpgaOptions):
        return {field.name: getattr(options, field.name) for field in fields(options)}
    return {
        "profile": options.profile,
        "system_id": options.system_id,
        "baud": options.baud,
        "messages_hz": {rate.name: rate.rate_hz for rate in options.message_rates},
        "arithmetic": options.arithmetic,
        "acquisition": options.acquisition,
        "calibrate_at_start": options.calibrate_at_start,
        "signing": options.signing,
    }


def sha256(content: bytes) -> str:
    """Return the hash by which a manifest knows a file."""
    return hashlib.sha256(content).hexdigest()


def read_manifest(folder: Path) -> Manifest:
    """Read the manifest of a generated folder; one without options has the defaults.

    Raises
    ------
    RenderError
        If there is none, or it is not one of hostkit's, or names a path outside the folder.
    """
    path = folder / MANIFEST
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
        files = tuple((str(name), str(value)) for name, value in document["files"].items())
        if document["schema"] != MANIFEST_SCHEMA:
            raise ValueError(f"schema is {document['schema']!r}")
        target, design = str(document["target"]), str(document["design"])
        options = _options_of(target, document.get("options"))
        cells = tuple(_cells(counts) for counts in document.get("cells", ()))
    except OSError as error:
        raise RenderError(
            f"{folder} holds no {MANIFEST}; it was not made by `hostkit generate`"
        ) from error
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise RenderError(f"{path} is not a manifest of hostkit: {str(error)[:100]}") from error
    for name, _ in files:
        _require_inside(path, name)
    return Manifest(target=target, digest=design, files=files, options=options, cells=cells)


def _require_inside(path: Path, name: str) -> None:
    pure = PurePosixPath(name)
    if pure.is_absolute() or ".." in pure.parts or not pure.parts:
        raise RenderError(f"{path} names {name!r}, which is outside its folder")


def _cells(document: Any) -> CellCounts:
    return CellCounts(
        entity=str(document["entity"]),
        lut=int(document["lut"]),
        flip_flops=int(document["flip_flops"]),
        dsp=int(document["dsp"]),
        block_ram=int(document["block_ram"]),
        tool=str(document["tool"]),
    )


def _options_of(target: str, document: Any) -> Options:
    """Return the options in a manifest; a target that is not known here is taken for firmware."""
    known = TARGETS[target] if target in TARGETS.names() else None
    if document is None:
        return DEFAULT_OPTIONS if known is None else default_options(known)
    return _fpga_options(document) if known and known.kind == "fpga" else _options(document)


def _fpga_options(document: Any) -> FpgaOptions:
    return FpgaOptions(
        bus=document["bus"],
        channels=int(document["channels"]),
        pipelined=bool(document["pipelined"]),
        clock_hz=None if document["clock_hz"] is None else int(document["clock_hz"]),
        oscillator_hz=(
            None if document["oscillator_hz"] is None else int(document["oscillator_hz"])
        ),
        baud=None if document["baud"] is None else int(document["baud"]),
        profile=document["profile"],
        system_id=int(document["system_id"]),
        top_name=str(document["top_name"]),
    )


def _options(document: Any) -> FirmwareOptions:
    rates = tuple(
        MessageRate(name=str(name), rate_hz=float(hz))
        for name, hz in document["messages_hz"].items()
    )
    return FirmwareOptions(
        profile=document["profile"],
        system_id=int(document["system_id"]),
        baud=None if document["baud"] is None else int(document["baud"]),
        message_rates=rates,
        arithmetic=document["arithmetic"],
        acquisition=document["acquisition"],
        calibrate_at_start=bool(document["calibrate_at_start"]),
        signing=bool(document["signing"]),
    )
