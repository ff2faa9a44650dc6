"""The order in which VHDL sources have to be analysed."""

import re
from collections.abc import Mapping
from graphlib import CycleError, TopologicalSorter

from hostkit.errors import RenderError

_COMMENT = re.compile(r"--.*")
_UNIT = re.compile(r"^\s*(?:entity|package)\s+(\w+)\s+is\b", re.MULTILINE | re.IGNORECASE)
_NEEDED = re.compile(r"\b(?:use|entity)\s+work\.(\w+)", re.IGNORECASE)


def units(text: str) -> tuple[str, ...]:
    """Return the entities and packages that a source declares, in lower case."""
    return tuple(name.lower() for name in _UNIT.findall(_COMMENT.sub("", text)))


def vhdl_order(sources: Mapping[str, str]) -> tuple[str, ...]:
    """Sort sources so that each one comes after those it needs; ties by name.

    Parameters
    ----------
    sources
        Path and text.

    Raises
    ------
    RenderError
        If two sources declare a unit of one name, or need each other.
    """
    home: dict[str, str] = {}
    for path, text in sources.items():
        for unit in units(text):
            if unit in home:
                raise RenderError(f"{path} and {home[unit]} both declare {unit}")
            home[unit] = path
    needs = {
        path: {home[name] for name in _needed(text) if name in home} - {path}
        for path, text in sources.items()
    }
    return _sorted(needs)


def _needed(text: str) -> set[str]:
    return {name.lower() for name in _NEEDED.findall(_COMMENT.sub("", text))}


def _sorted(needs: Mapping[str, set[str]]) -> tuple[str, ...]:
    sorter = TopologicalSorter(needs)
    try:
        sorter.prepare()
    except CycleError as error:
        raise RenderError(f"VHDL sources need each other: {', '.join(error.args[1])}") from error
    order: list[str] = []
    while sorter.is_active():
        ready = sorted(sorter.get_ready())
        order.extend(ready)
        sorter.done(*ready)
    return tuple(order)
