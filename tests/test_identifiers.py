import shutil
import subprocess
from pathlib import Path

import pytest

from hostkit.errors import RenderError
from hostkit.identifiers import (
    LANGUAGES,
    LONGEST,
    SYSTEMVERILOG,
    VERILOG,
    VHDL,
    C,
    require_identifier,
)


@pytest.mark.parametrize("name", ["hk_top", "a", "Tilt2_core", "x" * LONGEST])
def test_good_names_pass(name: str) -> None:
    assert require_identifier("top name", name) == name


@pytest.mark.parametrize(
    "name",
    ["", "2top", "_top", "top_", "a__b", "a-b", "a b", "t\u00f6p", "a\n", "x" * (LONGEST + 1)],
)
def test_what_is_no_identifier_is_refused(name: str) -> None:
    with pytest.raises(RenderError, match="top name"):
        require_identifier("top name", name)


@pytest.mark.parametrize("language", LANGUAGES, ids=lambda language: language.name)
def test_reserved_words_are_refused_in_any_case(language) -> None:
    for word in language.words:
        for name in (word, word.upper()):
            with pytest.raises(RenderError, match=f"reserved word of .*{language.name}"):
                require_identifier("register", name)


def _refused(command: list[str], source: Path, text: str) -> bool:
    source.write_text(text, encoding="ascii")
    result = subprocess.run([*command, str(source)], cwd=source.parent, capture_output=True)
    return result.returncode != 0


@pytest.mark.parametrize("name", ["tilt", "blend"])
@pytest.mark.parametrize(
    ("language", "command", "suffix", "text"),
    [
        (VHDL, ["ghdl", "-s", "--std=93"], "vhd", "entity {} is end;"),
        (VERILOG, ["iverilog", "-g2001", "-o", "/dev/null"], "v", "module t; wire {}; endmodule"),
        (C, ["gcc", "-std=c99", "-fsyntax-only"], "c", "int {};"),
    ],
    ids=lambda value: getattr(value, "name", ""),
)
def test_the_tools_agree(tmp_path: Path, name: str, language, command, suffix, text) -> None:
    if shutil.which(command[0]) is None:
        pytest.skip(f"{command[0]} is not installed")
    source = tmp_path / f"name.{suffix}"
    assert not _refused(command, source, text.format(name))
    word = sorted(language.words)[0]
    assert _refused(command, source, text.format(word))


def test_a_word_is_listed_once() -> None:
    assert not VERILOG.words & SYSTEMVERILOG.words
