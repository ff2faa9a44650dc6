"""Rendering: contexts, the Jinja environment, the writer and its manifest."""

from hostkit.render.manifest import read_manifest
from hostkit.render.options import DEFAULT_OPTIONS, FirmwareOptions, MessageRate
from hostkit.render.writer import (
    generate,
    render_target,
    stale_files,
    target_of,
    write,
)

__all__ = [
    "DEFAULT_OPTIONS",
    "FirmwareOptions",
    "MessageRate",
    "generate",
    "read_manifest",
    "render_target",
    "stale_files",
    "target_of",
    "write",
]
