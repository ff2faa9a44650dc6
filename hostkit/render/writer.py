"""From a design to files in a folder: render, compare, write, and the manifest that names them."""

import hashlib
import json
from dataclasses import dataclass, fields
from pathlib import Path, PurePosixPath

from hostkit import __version__
from hostkit.design_file import design_text, digest
from hostkit.dialect import c_headers
from hostkit.errors import HostkitError, RenderError
from hostkit.files import write_aside
from hostkit.records import FilterDesign, GeneratedFile
from hostkit.render.context import RenderContext, render_context
from hostkit.render.environment import environment, template_root
from hostkit.targets import TARGETS, Target

MANIFEST = "manifest.json"
MANIFEST_SCHEMA = "hostkit.manifest/1"
DESIGN = "design.json"


def render_target(design: FilterDesign, target: Target) -> tuple[GeneratedFile, ...]:
    """Render the files that come from hostkit's own templates, sorted by path.

    Raises
    ------
    HostkitError
        If the design does not fit the target.
    """
    context = render_context(design, target)
    root = template_root(target.kind)
    env = environment(root)
    names = {field.name: getattr(context, field.name) for field in fields(RenderContext)}
    files = []
    for folder in (*target.folders, design.filter):
        for path in sorted(p for p in (root / folder).rglob("*") if p.is_file()):
            template = path.relative_to(root).as_posix()
            output = path.relative_to(root / folder).as_posix()
            if path.suffix == ".j2":
                text = env.get_template(template).render(banner=context.banner(template), **names)
                files.append(
                    GeneratedFile(path=output.removesuffix(".j2"), content=_checked(text, template))
                )
            else:
                files.append(GeneratedFile(path=output, content=path.read_text(encoding="ascii")))
    return _sorted_unique(files)


def generate(design: FilterDesign, target: Target) -> tuple[GeneratedFile, ...]:
    """Return everything that `hostkit generate` writes: code, MAVLink headers, design, manifest."""
    files = list(render_target(design, target))
    if target.kind == "mcu":
        files.extend(c_headers())
    files.append(GeneratedFile(path=DESIGN, content=design_text(design)))
    files.append(GeneratedFile(path=MANIFEST, content=_manifest(design, target, files)))
    return _sorted_unique(files)


def _checked(text: str, template: str) -> str:
    if not text.isascii() or "\r" in text:
        raise RenderError(f"{template} rendered to text that is not ASCII with line feeds")
    return text


def _sorted_unique(files: list[GeneratedFile]) -> tuple[GeneratedFile, ...]:
    by_path = {file.path: file for file in files}
    if len(by_path) != len(files):
        raise RenderError("two templates make one file; the folders of a target must not overlap")
    return tuple(by_path[path] for path in sorted(by_path))


def _sha256(content: str) -> str:
    return hashlib.sha256(content.encode("utf-8")).hexdigest()


def _manifest(design: FilterDesign, target: Target, files: list[GeneratedFile]) -> str:
    document = {
        "schema": MANIFEST_SCHEMA,
        "hostkit": __version__,
        "target": target.name,
        "design": digest(design),
        "files": {file.path: _sha256(file.content) for file in files},
    }
    return json.dumps(document, indent=2, sort_keys=True) + "\n"


@dataclass(frozen=True, slots=True, kw_only=True)
class Manifest:
    """What a folder says of itself: target, design digest, and the hash of every file."""

    target: str
    digest: str
    files: tuple[tuple[str, str], ...]


def read_manifest(folder: Path) -> Manifest:
    """Read the manifest of a generated folder.

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
    except OSError as error:
        raise RenderError(
            f"{folder} holds no {MANIFEST}; it was not made by `hostkit generate`"
        ) from error
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise RenderError(f"{path} is not a manifest of hostkit: {str(error)[:100]}") from error
    for name, _ in files:
        pure = PurePosixPath(name)
        if pure.is_absolute() or ".." in pure.parts or not pure.parts:
            raise RenderError(f"{path} names {name!r}, which is outside its folder")
    return Manifest(target=target, digest=design, files=files)


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
    for name, sha256 in read_manifest(folder).files:
        path = folder / name
        unchanged = path.is_file() and hashlib.sha256(path.read_bytes()).hexdigest() == sha256
        if name not in wanted and unchanged:
            path.unlink()


def target_of(folder: Path) -> Target:
    """Return the target that a generated folder was made for."""
    return TARGETS[read_manifest(folder).target]
