from pathlib import Path

import jinja2
import jinja2.nodes
import pytest

ROOT = Path(__file__).resolve().parents[2]
TEMPLATES = sorted(
    path
    for folder in ("firmware_templates", "hdl_templates")
    for path in (ROOT / folder).rglob("*.j2")
)
COMPUTING = (jinja2.nodes.BinExpr, jinja2.nodes.Concat, jinja2.nodes.Neg, jinja2.nodes.Pos)
LOGIC = (jinja2.nodes.And, jinja2.nodes.Or)
FILTERS = {"real", "hex", "macro", "padded"}


def computing_nodes(text: str) -> list[str]:
    tree = jinja2.Environment().parse(text) if "|" not in text else _parse(text)
    nodes = [n for n in tree.find_all(COMPUTING) if not isinstance(n, LOGIC)]
    found = [f"line {node.lineno}: {type(node).__name__}" for node in nodes]
    for node in tree.find_all(jinja2.nodes.Filter):
        if node.name not in FILTERS:
            found.append(f"line {node.lineno}: filter {node.name}")
    found += [f"line {n.lineno}: call" for n in tree.find_all(jinja2.nodes.Call)]
    found += [f"line {n.lineno}: set" for n in tree.find_all(jinja2.nodes.Assign)]
    return found


def _parse(text: str) -> jinja2.nodes.Template:
    env = jinja2.Environment()
    env.filters |= dict.fromkeys(FILTERS, str)
    return env.parse(text)


def test_there_are_templates() -> None:
    assert len(TEMPLATES) > 4


@pytest.mark.parametrize("path", TEMPLATES, ids=lambda p: p.name)
def test_template_computes_nothing(path: Path) -> None:
    assert computing_nodes(path.read_text(encoding="utf-8")) == []


@pytest.mark.parametrize(
    "text",
    [
        "{{ a + b }}",
        "{{ a * 2 }}",
        "{{ -a }}",
        "{{ a ~ b }}",
        "{{ a | round }}",
        "{{ f(a) }}",
        "{% set a = 1 %}",
        "{{ 2 ** a }}",
        "{{ a // b }}",
    ],
)
def test_check_finds_computation(text: str) -> None:
    assert computing_nodes(text)


@pytest.mark.parametrize("path", TEMPLATES, ids=lambda p: p.name)
def test_template_begins_with_banner(path: Path) -> None:
    first, second = path.read_text(encoding="utf-8").splitlines()[:2]
    assert "{{ banner }}" in (second if first.startswith("#!") else first)
