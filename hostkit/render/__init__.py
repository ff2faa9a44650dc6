"""Rendering: contexts, the Jinja environment, the writer and its manifest."""

from hostkit.render.choices import Options, default_options
from hostkit.render.fpga_options import FpgaOptions
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
    "FpgaOptions",
    "MessageRate",
    "Options",
    "default_options",
    "generate",
    "read_manifest",
    "render_target",
    "stale_files",
    "target_of",
    "write",
]
