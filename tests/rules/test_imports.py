import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

FLOORS = (
    ("__main__",),
    ("cli",),
    ("web",),
    ("report",),
    ("monitor", "importers"),
    ("validation", "flashing", "comparison"),
    ("synthesis",),
    ("emulation",),
    ("link",),
    ("render",),
    ("dialect", "targets"),
    ("fleet", "reproduction"),
    ("tuning", "calibration", "smoothing"),
    ("filters",),
    ("optimisers",),
    ("diagnosis",),
    ("simulation",),
    ("sensors",),
    ("recordings",),
    ("attitude",),
    ("design_file",),
    ("trace",),
    (
        "records",
        "spec",
        "mounting",
        "registry",
        "fixedpoint",
        "units",
        "errors",
        "files",
        "identifiers",
        "json_object",
        "literals",
        "provenance",
    ),
)
"""From top to bottom; an import may only point down, or stay within its room."""

LEVEL = {room: level for level, rooms in enumerate(FLOORS) for room in rooms}
MODULES = sorted((ROOT / "hostkit").rglob("*.py"))


def imported_rooms(path: Path) -> set[str]:
    rooms = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        names = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            names = [node.module or ""]
            if node.module == "hostkit":
                names = [f"hostkit.{alias.name}" for alias in node.names]
        rooms |= {name.split(".")[1] for name in names if name.startswith("hostkit.")}
    return rooms & set(LEVEL)


def test_every_room_has_a_floor() -> None:
    rooms = {p.stem for p in (ROOT / "hostkit").iterdir() if p.name != "__pycache__"} - {"__init__"}
    assert rooms - {"_templates"} == set(LEVEL)


@pytest.mark.parametrize("path", MODULES, ids=lambda p: str(p.relative_to(ROOT)))
def test_imports_point_down(path: Path) -> None:
    room = path.relative_to(ROOT / "hostkit").parts[0].removesuffix(".py")
    if room == "__init__":
        return
    for other in imported_rooms(path) - {room}:
        below = LEVEL[other] > LEVEL[room]
        same_bottom = LEVEL[other] == LEVEL[room] == len(FLOORS) - 1
        assert below or same_bottom, f"{path} imports {other}, which is above it"
