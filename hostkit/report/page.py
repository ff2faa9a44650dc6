"""A report as one HTML file: facts, figures and tables, no script and no outside request."""

from dataclasses import dataclass, field
from pathlib import Path

import jinja2

from hostkit import __version__
from hostkit.files import write_aside


@dataclass(frozen=True, slots=True, kw_only=True)
class Fact:
    """One number that stands in large type."""

    label: str
    value: str
    note: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """A table; columns after the first are numbers unless `is_text`."""

    title: str
    header: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    note: str = ""
    is_text: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Plot:
    """A figure as SVG text that hostkit drew, with what it shows."""

    title: str
    caption: str
    svg: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Page:
    """Everything on a report. `verdict` is None where there is none to give."""

    title: str
    subtitle: str
    facts: tuple[Fact, ...]
    sections: tuple[Table | Plot, ...]
    verdict: str | None = None
    provenance: tuple[tuple[str, str], ...] = field(default=())


def write_page(page: Page, path: Path) -> None:
    """Write a report, aside and then renamed.

    Raises
    ------
    HostkitError
        If the file cannot be written.
    """
    write_aside(path, page_text(page))


def page_text(page: Page) -> str:
    """Return a report as the text of its file."""
    env = jinja2.Environment(
        loader=jinja2.FileSystemLoader(Path(__file__).parent),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    return env.get_template("page.html.j2").render(page=page, version=__version__)
