"""Rendering: contexts, the Jinja environment, the writer and its manifest."""

from hostkit.render.writer import (
    generate,
    read_manifest,
    render_target,
    stale_files,
    target_of,
    write,
)

__all__ = ["generate", "read_manifest", "render_target", "stale_files", "target_of", "write"]
