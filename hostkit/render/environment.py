"""The Jinja environment: it places text and computes nothing."""

import re
from pathlib import Path

import jinja2

from hostkit.errors import RenderError

PACKAGE = Path(__file__).resolve().parent.parent


def template_root(kind: str) -> Path:
    """Return the folder of the C (``mcu``) or VHDL (``fpga``) templates.

    They stand beside the package in a checkout and inside it in an installed wheel.
    """
    name = {"mcu": "firmware", "fpga": "hdl"}[kind]
    for root in (PACKAGE.parent / f"{name}_templates", PACKAGE / "_templates" / name):
        if root.is_dir():
            return root
    raise RenderError(f"the {name} templates are missing from the installation of hostkit")


def environment(root: Path) -> jinja2.Environment:
    """Return the environment in which every template is rendered."""
    env = jinja2.Environment(
        loader=jinja2.FileSystemLoader(root),
        undefined=jinja2.StrictUndefined,
        autoescape=False,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    env.filters = {"real": repr, "hex": _hex, "macro": _macro, "padded": str.ljust}
    return env


def _hex(value: int, digits: int = 2) -> str:
    return f"{value:0{digits}X}"


def _macro(name: str) -> str:
    """Return a name as a C macro; anything but letters, digits and underscores is refused."""
    if not re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", name):
        raise RenderError(f"{name!r} is not an identifier of C and VHDL")
    return name.upper()
