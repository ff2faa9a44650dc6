"""The demo, as a newcomer runs it."""

import json
import os
import shutil
from html.parser import HTMLParser
from pathlib import Path

import pytest

from hostkit.cli.main import run
from hostkit.emulation.tools import TOOLS, find
from hostkit.targets import TARGETS


class Page(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.links: list[str] = []
        self.text = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.links += [v for k, v in attrs if k in ("src", "href") and v and not v.startswith("#")]

    def handle_data(self, data: str) -> None:
        self.text += data


def test_demo_passes_and_its_report_stands_alone(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    missing = [t.name for t in TOOLS if not find(t).found]
    if missing:
        pytest.skip(f"not installed: {', '.join(missing)}")
    out = tmp_path / "demo"
    assert run(["demo", "--out", str(out), "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert (document["schema"], document["verdict"]) == ("hostkit.demo/1", "pass")
    assert all(step["ok"] for step in document["steps"])
    names = [step["name"] for step in document["steps"]]
    assert names == [
        "simulate",
        "simulate",
        "tune",
        *TARGETS.names(),
        "monitor",
    ]
    page = Page()
    page.feed(Path(document["report"]).read_text(encoding="utf-8"))
    assert page.tags.count("svg") == 6
    assert "script" not in page.tags
    assert page.links == []
    for wanted in ("verdict: pass", "Convergence", "Fit", "Residual of each device", "Provenance"):
        assert wanted in page.text


def test_demo_goes_on_without_optional_toolchains(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """All of the machine's programs but the optional ones: the host target still runs."""
    if shutil.which("gcc") is None or shutil.which("make") is None:
        pytest.skip("gcc and make are not installed")
    only = tmp_path / "bin"
    only.mkdir()
    for folder in os.environ["PATH"].split(os.pathsep):
        for program in Path(folder).glob("*"):
            optional = program.name.startswith(("avr-", "arm-", "ghdl", "node", "clang", "wasm-ld"))
            if not optional and not (only / program.name).exists():
                (only / program.name).symlink_to(program)
    monkeypatch.setenv("PATH", str(only))
    assert run(["demo", "--out", str(tmp_path / "demo"), "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    details = {step["name"]: step["detail"] for step in document["steps"]}
    assert document["verdict"] == "pass"
    assert "left out" in details["atmega328p"]
    assert "left out" in details["spartan3adsp"]
    assert "left out" in details["rp2040"]
    assert "left out" in details["stm32f103"]
    assert details["host"].startswith("3000 samples")
    assert details["monitor"].startswith("host over a pseudo-terminal")
