"""Puts uPlot, which draws the charts of the monitor page, into what is built."""

from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

PAGE = "hostkit/web/page"
VENDOR = f"{PAGE}/vendor"
FILES = ("uPlot.esm.js", "uPlot.min.css", "LICENSE", "package.json")


class UplotHook(BuildHookInterface):
    """Adds the few files of uPlot that the page needs, with their licence."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Name the files; a wheel without them works, and its page says what is missing."""
        if version == "editable":  # the page is read where npm put it
            return
        for name in FILES:
            file = self._find(name)
            if file is None:
                self.app.display_warning(
                    f"{name} of uPlot is missing, so the page of `hostkit monitor --web` will "
                    f"have no charts: npm install --prefix {PAGE}"
                )
                return
            build_data["force_include"][str(file)] = f"{VENDOR}/{name}"

    def _find(self, name: str) -> Path | None:
        """Look where npm puts it, and where an sdist has it."""
        root = Path(self.root)
        package = root / PAGE / "node_modules" / "uplot"
        places = (package / "dist" / name, package / name, root / VENDOR / name)
        return next((place for place in places if place.is_file()), None)
