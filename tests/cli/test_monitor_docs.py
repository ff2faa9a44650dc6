"""What the documentation says of options and JSON keys is what the commands have."""

import json
import re
from pathlib import Path

import click
import pytest
from designs import design
from device import Device

from hostkit.cli.main import COMMANDS, cli, run
from hostkit.design_file import save_design
from hostkit.link.logs.tlog import STAMP

DOCS = Path(__file__).resolve().parents[2] / "docs"
OTHERS = {"--master"}
"""Options of other programs."""


def options() -> set[str]:
    context = click.Context(cli)
    found: set[str] = set()
    for name in COMMANDS:
        command = cli.get_command(context, name)
        parts = [command, *getattr(command, "commands", {}).values()]
        found |= {text for part in parts for one in part.params for text in one.opts}
    return found


def test_every_option_of_the_page_exists() -> None:
    named = set(re.findall(r"(?<![-\w])--[a-z][a-z-]+", (DOCS / "monitor.md").read_text("utf-8")))
    assert len(named) > 15
    assert named - OTHERS <= options()


def keys(value: object) -> set[str]:
    if isinstance(value, dict):
        return set(value) | {key for inner in value.values() for key in keys(inner)}
    if isinstance(value, list):
        return {key for inner in value for key in keys(inner)}
    return set()


@pytest.mark.parametrize("command", ["monitor", "record"])
def test_every_key_is_documented(
    command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    device = Device(design())
    save_design(device.design, tmp_path / "design.json")
    frames = device.frames(100)
    stamped = (STAMP.pack(10**15 + 10_000 * k) + frame for k, frame in enumerate(frames))
    (tmp_path / "flight.tlog").write_bytes(b"".join(stamped))
    arguments = ["--port", f"file:{tmp_path / 'flight.tlog'}", "--json"]
    if command == "monitor":
        arguments = [str(tmp_path / "design.json"), *arguments]
    else:
        arguments += ["-o", str(tmp_path / "copy.tlog")]
    assert run([command, *arguments]) == 0
    document = json.loads(capsys.readouterr().out)
    document.pop("schema")
    document.pop("session", None)
    thresholds = document.pop("thresholds", {})
    documented = set(re.findall(r"`([a-z0-9_]+)`", (DOCS / "cli.md").read_text("utf-8")))
    assert keys(document) <= documented
    limits = set(re.findall(r"max_[a-z0-9_]+", (DOCS / "monitor.md").read_text("utf-8")))
    options = re.findall(r"--max[a-z0-9-]+", (DOCS / "monitor.md").read_text("utf-8"))
    assert set(thresholds) <= limits | {option[2:].replace("-", "_") for option in options}
