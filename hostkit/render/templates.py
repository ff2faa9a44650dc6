"""Renders the template folders of a target."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, fields
from pathlib import Path

import jinja2

from hostkit.errors import RenderError
from hostkit.records import GeneratedFile
from hostkit.render.context import RenderContext
from hostkit.render.environment import environment, template_root
from hostkit.render.project import project_context

HDL_SUFFIXES = (".vhd", ".v")
TOP = "top."
"""What begins so in the folder of a board is called after the top."""
BENCH_FOLDER = "sim"
TEMPLATE = ".j2"


@dataclass(frozen=True, slots=True, kw_only=True)
class Template:
    """A template or a plain file: where it is, and what it becomes."""

    path: Path
    name: str
    output: str
    folder: str


def render_folders(context: RenderContext, folders: Iterable[str]) -> list[GeneratedFile]:
    """Render all files of some template folders.

    HDL comes first; the other files of an FPGA target may then name its sources.

    Raises
    ------
    RenderError
        If a text is not ASCII with line feeds.
    """
    root = template_root(context.target.kind)
    env = environment(root)
    names = {field.name: getattr(context, field.name) for field in fields(RenderContext)}
    templates = list(_templates(context, root, folders))
    if context.fpga is None:
        return [_rendered(env, context, template, names) for template in templates]
    hdl = [template for template in templates if template.output.endswith(HDL_SUFFIXES)]
    files = [_rendered(env, context, template, names) for template in hdl]
    benches = {template.output for template in hdl if template.folder == BENCH_FOLDER}
    others = [template for template in templates if template not in hdl]
    names["project"] = project_context(
        {file.path: file.content for file in files},
        benches,
        [template.output for template in others],
    )
    return files + [_rendered(env, context, template, names) for template in others]


def checked(text: str, template: str) -> str:
    """Return a text if it is fit to be written anywhere."""
    if not text.isascii() or "\r" in text:
        raise RenderError(f"{template} rendered to text that is not ASCII with line feeds")
    return text


def _templates(context: RenderContext, root: Path, folders: Iterable[str]) -> Iterator[Template]:
    for folder in folders:
        for path in sorted(p for p in (root / folder).rglob("*") if p.is_file()):
            inside = path.relative_to(root / folder)
            name = inside.name.removesuffix(TEMPLATE)
            if context.fpga is not None and folder == context.target.name and name.startswith(TOP):
                name = f"{context.fpga.top_name}.{name.removeprefix(TOP)}"
            yield Template(
                path=path,
                name=path.relative_to(root).as_posix(),
                output=inside.with_name(name).as_posix(),
                folder=folder,
            )


def _rendered(
    env: jinja2.Environment, context: RenderContext, template: Template, names: Mapping[str, object]
) -> GeneratedFile:
    if template.path.suffix != TEMPLATE:
        content = template.path.read_text(encoding="ascii")
        return GeneratedFile(path=template.output, content=content)
    banner = context.banner(template.name)
    text = env.get_template(template.name).render(banner=banner, **names)
    return GeneratedFile(path=template.output, content=checked(text, template.name))
