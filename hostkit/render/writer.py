"""From a design to files in a folder: render, compare, write."""

import re
from pathlib import Path

from hostkit.design_file import design_text
from hostkit.dialect import c_headers
from hostkit.errors import HostkitError, RenderError
from hostkit.files import write_aside
from hostkit.records import FilterDesign, GeneratedFile
from hostkit.render.choices import Options, default_options
from hostkit.render.context import render_context
from hostkit.render.core_context import core_folders
from hostkit.render.environment import environment, template_root
from hostkit.render.fpga_report import CellCounts
from hostkit.render.manifest import MANIFEST, manifest_text, read_manifest, sha256
from hostkit.render.options import FirmwareOptions
from hostkit.render.templates import checked, render_folders
from hostkit.targets import TARGETS, Target

DESIGN = "design.json"
SKETCH = "arduino/sketch.ino.j2"
SKETCH_NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.-]{0,61}[A-Za-z0-9_-]|[A-Za-z0-9_]")
"""What the sketch specification of Arduino allows: up to 63 characters, no dot at the end."""


def render_target(
    design: FilterDesign,
    target: Target,
    options: Options | None = None,
    *,
    cells: tuple[CellCounts, ...] = (),
) -> tuple[GeneratedFile, ...]:
    """Render the files that come from hostkit's own templates, sorted by path.

    Parameters
    ----------
    cells
        Resources of an FPGA, if they were measured.

    Raises
    ------
    HostkitError
        If the design or the options do not fit the target.
    """
    context = render_context(design, target, options, cells=cells)
    folders = (*target.folders, *_filter_folders(design, target, context.options))
    return _sorted_unique(render_folders(context, folders))


def _filter_folders(
    design: FilterDesign, target: Target, options: FirmwareOptions
) -> tuple[str, ...]:
    """Return the folder of the filter, and those of what it shares with other filters."""
    if options.arithmetic == "float":
        return (f"{design.filter}_float",)
    shared = ("fixed",) if target.kind == "mcu" else core_folders(design.filter)
    return (*shared, design.filter)


def generate(
    design: FilterDesign,
    target: Target,
    options: Options | None = None,
    *,
    folder: Path | None = None,
    cells: tuple[CellCounts, ...] = (),
) -> tuple[GeneratedFile, ...]:
    """Return everything that `hostkit generate` writes: code, MAVLink headers, design, manifest.

    Parameters
    ----------
    folder
        Where it will be written. An Arduino sketch has the name of its folder, so without one, or
        with a name that the Arduino IDE does not allow, there is none.
    cells
        Resources of an FPGA, if they were measured; they stand in its README and manifest.

    Raises
    ------
    HostkitError
        If the design or the options do not fit the target.
    """
    options = default_options(target) if options is None else options
    files = list(render_target(design, target, options, cells=cells))
    if target.kind == "mcu":
        files.extend(c_headers())
    files.extend(_sketch(design, target, options, folder))
    files.append(GeneratedFile(path=DESIGN, content=design_text(design)))
    files.append(
        GeneratedFile(path=MANIFEST, content=manifest_text(design, target, options, files, cells))
    )
    return _sorted_unique(files)


def _sketch(
    design: FilterDesign, target: Target, options: Options, folder: Path | None
) -> tuple[GeneratedFile, ...]:
    name = "" if folder is None else folder.resolve().name
    if not target.arduino or not SKETCH_NAME.fullmatch(name):
        return ()
    banner = render_context(design, target, options).banner(SKETCH)
    text = environment(template_root(target.kind)).get_template(SKETCH).render(banner=banner)
    return (GeneratedFile(path=f"{name}.ino", content=checked(text, SKETCH)),)


def _sorted_unique(files: list[GeneratedFile]) -> tuple[GeneratedFile, ...]:
    by_path = {file.path: file for file in files}
    if len(by_path) != len(files):
        raise RenderError("two templates make one file; the folders of a target must not overlap")
    return tuple(by_path[path] for path in sorted(by_path))


def stale_files(files: tuple[GeneratedFile, ...], folder: Path) -> tuple[str, ...]:
    """Return the paths that are missing from `folder` or differ there, byte for byte."""
    return tuple(
        file.path for file in files if not _equals(folder / file.path, file.content.encode("utf-8"))
    )


def _equals(path: Path, content: bytes) -> bool:
    try:
        return path.read_bytes() == content
    except OSError:
        return False


def write(files: tuple[GeneratedFile, ...], folder: Path) -> tuple[str, ...]:
    """Write what differs and remove what an earlier run left; return the paths written.

    The manifest is written last, so a folder without one was not finished. A file of an earlier
    run that was changed by hand since is left where it is.

    Raises
    ------
    HostkitError
        If a file cannot be written.
    """
    stale = stale_files(files, folder)
    _remove_leftovers(files, folder)
    by_path = {file.path: file for file in files}
    for path in sorted(stale, key=lambda name: (name == MANIFEST, name)):
        destination = folder / path
        try:
            destination.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise HostkitError(f"{destination.parent} cannot be made: {error.strerror}") from error
        write_aside(destination, by_path[path].content)
    return stale


def _remove_leftovers(files: tuple[GeneratedFile, ...], folder: Path) -> None:
    if not (folder / MANIFEST).is_file():
        return
    wanted = {file.path for file in files}
    for name, hashed in read_manifest(folder).files:
        path = folder / name
        unchanged = path.is_file() and sha256(path.read_bytes()) == hashed
        if name not in wanted and unchanged:
            path.unlink()


def target_of(folder: Path) -> Target:
    """Return the target that a generated folder was made for."""
    return TARGETS[read_manifest(folder).target]
