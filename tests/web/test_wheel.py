"""The charts' library in what is built from a checkout."""

import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from test_page import need_uplot

ROOT = Path(__file__).resolve().parents[2]
VENDOR = "hostkit/web/page/vendor"
FILES = {
    f"{VENDOR}/{name}" for name in ("uPlot.esm.js", "uPlot.min.css", "LICENSE", "package.json")
}


def build(target: str, root: Path, folder: Path) -> tuple[Path, str]:
    """Build as `python -m build` would, but without a network."""
    pytest.importorskip("hatchling")
    done = subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "-t", target, "-d", str(folder)],
        cwd=root,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    said = done.stdout + done.stderr
    assert done.returncode == 0, said
    return next(folder.iterdir()), said


def test_a_wheel_has_the_page_with_its_charts_also_when_made_from_an_sdist(tmp_path: Path) -> None:
    need_uplot()
    packed, _ = build("sdist", ROOT, tmp_path / "sdist")
    shutil.unpack_archive(packed, tmp_path / "source")
    (source,) = (tmp_path / "source").iterdir()
    for name, root in (("checkout", ROOT), ("from_sdist", source)):
        wheel, said = build("wheel", root, tmp_path / name)
        assert "uPlot" not in said
        with zipfile.ZipFile(wheel) as archive:
            names = set(archive.namelist())
        assert names >= FILES
        assert names >= {
            f"hostkit/web/page/{file}" for file in ("index.html", "main.js", "page.css")
        }
        assert not [entry for entry in names if "node_modules" in entry]


def test_a_wheel_without_uplot_is_built_with_a_warning(tmp_path: Path) -> None:
    source = tmp_path / "source"
    (source / "hostkit").mkdir(parents=True)
    (source / "hostkit" / "__init__.py").write_text('__version__ = "1.0"\n')
    (source / "hatch_build.py").write_bytes((ROOT / "hatch_build.py").read_bytes())
    (source / "pyproject.toml").write_text(
        '[build-system]\nrequires = ["hatchling"]\nbuild-backend = "hatchling.build"\n'
        '[project]\nname = "hostkit"\nversion = "1.0"\n[tool.hatch.build.hooks.custom]\n'
    )
    wheel, said = build("wheel", source, tmp_path / "built")
    assert "npm install --prefix hostkit/web/page" in said
    with zipfile.ZipFile(wheel) as archive:
        assert not [name for name in archive.namelist() if "vendor" in name]
