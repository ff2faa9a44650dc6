"""What all tests share."""

import os
import subprocess
from collections.abc import Generator, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from hostkit.emulation.tools import require
from hostkit.errors import ToolMissingError

ROOT = Path(__file__).resolve().parents[1]
NO_DATA = "HOSTKIT_DATA"
STRICT_C = ("-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wconversion", "-Werror")
SANITIZERS = ("-fsanitize=address,undefined", "-fno-sanitize-recover")


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--update-golden", action="store_true", help="rewrite generated/")


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, Any, None]:
    """With HOSTKIT_NO_SKIP set, a skip is a failure unless real recordings are what is missing."""
    outcome = yield
    report = outcome.get_result()
    if report.skipped and os.environ.get("HOSTKIT_NO_SKIP") and NO_DATA not in str(report.longrepr):
        report.outcome = "failed"
        report.longrepr = f"skipped where nothing may be: {report.longrepr}"


@pytest.fixture(scope="session")
def data_folder() -> Path:
    """Folder of real recordings; tests that need it are skipped where it is absent."""
    folder = Path(os.environ.get("HOSTKIT_DATA", ROOT.parent / "shared" / "data"))
    if not folder.is_dir():
        pytest.skip(f"no real recordings in {folder}; {NO_DATA} names their folder")
    return folder


@dataclass(frozen=True)
class Compiler:
    """The host's C compiler, strict, with sanitizers."""

    def build(self, output: Path, *arguments: str | Path) -> Path:
        command = ["gcc", *STRICT_C, *SANITIZERS, "-O1", "-o", str(output)]
        subprocess.run([*command, *map(str, arguments)], check=True, timeout=120)
        return output

    @staticmethod
    def run(program: Path, rows: Iterable[Iterable[object]]) -> list[list[str]]:
        """Feed rows of words to a program; give the words of each line it prints."""
        text = "\n".join(" ".join(map(str, row)) for row in rows)
        done = subprocess.run(
            [program], input=text, capture_output=True, text=True, check=True, timeout=60
        )
        return [line.split() for line in done.stdout.splitlines()]


@pytest.fixture(scope="session")
def host_cc() -> Compiler:
    try:
        require("gcc")
    except ToolMissingError as error:
        pytest.skip(str(error))
    return Compiler()
