"""Only a filter's own packages know it; all else asks its record."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "hostkit"

OWN = {
    "complementary": (
        "filters/complementary",
        "tuning/complementary",
        "reproduction",  # a paper's complementary filter
    ),
    "observer": ("filters/observer", "tuning/observer"),
}
"""Who may import a filter's modules: its own packages, and what is about this very filter."""

REGISTRIES = {"filters/__init__.py": "hostkit.filters", "tuning/tuners.py": "hostkit.tuning"}
"""Where filters are named, once, and of which room."""


def modules() -> list[Path]:
    return sorted(PACKAGE.rglob("*.py"))


def imported(path: Path) -> set[str]:
    """Return the modules and the names that a module imports, with dots."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            found |= {f"{node.module}.{alias.name}" for alias in node.names}
    return found


def offences(place: str, names: set[str]) -> set[str]:
    """Return what a module of the package must not import."""
    found = set()
    for filter_, own in OWN.items():
        if any(place.startswith(f"{folder}/") for folder in own):
            continue
        for room in ("hostkit.filters", "hostkit.tuning"):
            if REGISTRIES.get(place) == room:
                continue
            whole = f"{room}.{filter_}"
            found |= {name for name in names if f"{name}.".startswith(f"{whole}.")}
    return found


def test_every_filter_has_its_rule() -> None:
    folders = {p.parent.name for p in (PACKAGE / "filters").glob("*/lowering.py")}
    assert folders == set(OWN)


@pytest.mark.parametrize("path", modules(), ids=lambda p: str(p.relative_to(PACKAGE)))
def test_only_its_own_packages_import_a_filter(path: Path) -> None:
    place = path.relative_to(PACKAGE).as_posix()
    assert offences(place, imported(path)) == set()


@pytest.mark.parametrize(
    ("place", "name"),
    [
        ("cli/demo.py", "hostkit.filters.complementary.eta_from_tau"),
        ("tuning/tune.py", "hostkit.tuning.complementary.tuner.tuning_problem"),
        ("filters/observer/spec.py", "hostkit.filters.complementary"),
        ("filters/__init__.py", "hostkit.tuning.observer"),
    ],
)
def test_the_rule_finds_an_offence(place: str, name: str) -> None:
    assert offences(place, {name}) == {name}
    assert offences(place, {"hostkit.filters.FILTERS", "hostkit.tuning.TUNERS"}) == set()
