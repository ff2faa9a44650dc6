"""Puts uPlot, which draws the charts of the monitor page, into the wheel if npm installed it."""

from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

PAGE = "hostkit/web/page"
PACKAGE = f"{PAGE}/node_modules/uplot"
FILES = ("dist/uPlot.esm.js", "dist/uPlot.min.css", "LICENSE", "package.json")


class UplotHook(BuildHookInterface):  # type: ignore[type-arg]
    """Adds the few files of uPlot that the page needs, with their licence."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Name the files; a wheel without them works, and its page says what is missing."""
        package = Path(self.root) / PACKAGE
        if not package.is_dir():
            self.app.display_warning(
                f"uPlot is not installed, so the page of `hostkit monitor --web` will have no "
                f"charts: npm install --prefix {PAGE}"
            )
            return
        for file in FILES:
            name = Path(file).name
            build_data["force_include"][str(package / file)] = f"{PAGE}/vendor/{name}"
