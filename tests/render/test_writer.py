import json
from pathlib import Path

import pytest
from designs import all_parameters, design

from hostkit.dialect import HIDDEN_WORDS, STATE_WORDS, python_module
from hostkit.errors import HostkitError, RenderError
from hostkit.render import generate, read_manifest, stale_files, target_of, write
from hostkit.render.context import render_context
from hostkit.render.link_plan import link_plan
from hostkit.spec import SAMPLE_HIDDEN_WORDS
from hostkit.targets import TARGETS


@pytest.fixture(params=TARGETS.names())
def target(request: pytest.FixtureRequest):
    return TARGETS[request.param]


def test_same_design_same_bytes_and_second_run_writes_nothing(target, tmp_path: Path) -> None:
    files = generate(design(), target)
    assert files == generate(design(), target)
    assert len(write(files, tmp_path)) == len(files)
    assert write(files, tmp_path) == ()
    assert stale_files(files, tmp_path) == ()
    assert target_of(tmp_path) is target


def test_files_are_plain_ascii_with_line_feeds(target) -> None:
    for file in generate(design(), target):
        assert "\r" not in file.content
        if not file.path.startswith("mavlink/"):
            assert file.content.isascii()
            assert file.content.endswith("\n")


def test_digest_is_compiled_in(target) -> None:
    from hostkit.design_file import digest

    d = design()
    bytes_c = ", ".join(f"0x{b:02X}" for b in bytes.fromhex(digest(d)))
    sources = [f.content for f in generate(d, target) if not f.path.endswith(".json")]
    assert any(digest(d) in text or bytes_c in text for text in sources)


def test_one_changed_byte_is_stale(tmp_path: Path) -> None:
    files = generate(design(), TARGETS["host"])
    write(files, tmp_path)
    victim = tmp_path / "hk_filter.c"
    victim.write_text(victim.read_text() + " ")
    assert stale_files(files, tmp_path) == ("hk_filter.c",)


def test_other_target_into_the_same_folder_leaves_no_leftovers(tmp_path: Path) -> None:
    write(generate(design(), TARGETS["atmega328p"]), tmp_path)
    (tmp_path / "notes.txt").write_text("mine")
    changed = tmp_path / "hk_app.c"
    changed.write_text("mine too")
    files = generate(design(), TARGETS["spartan3adsp"])
    write(files, tmp_path)
    found = {p.relative_to(tmp_path).as_posix() for p in tmp_path.rglob("*") if p.is_file()}
    assert found == {file.path for file in files} | {"notes.txt", "hk_app.c"}


@pytest.mark.parametrize("name", ["../outside", "/etc/passwd", ""])
def test_manifest_cannot_name_paths_outside(name: str, tmp_path: Path) -> None:
    write(generate(design(), TARGETS["spartan3adsp"]), tmp_path)
    manifest = tmp_path / "manifest.json"
    document = json.loads(manifest.read_text())
    document["files"][name] = "0" * 64
    manifest.write_text(json.dumps(document))
    with pytest.raises(RenderError, match="outside"):
        read_manifest(tmp_path)


@pytest.mark.parametrize("text", ["", "[]", "{}", '{"files": 1}', "\x00"])
def test_broken_manifest_is_refused(text: str, tmp_path: Path) -> None:
    (tmp_path / "manifest.json").write_text(text)
    with pytest.raises(RenderError, match="not a manifest"):
        read_manifest(tmp_path)


def test_unwritable_folder_is_one_clear_error(tmp_path: Path) -> None:
    blocker = tmp_path / "file"
    blocker.write_text("")
    with pytest.raises(HostkitError, match="cannot be"):
        write(generate(design(), TARGETS["host"]), blocker / "out")


def test_rate_that_the_sensor_cannot_make_is_refused_with_the_nearest() -> None:
    with pytest.raises(HostkitError, match=r"nearest is 90\.9091 Hz"):
        generate(design(rate_hz=95.0), TARGETS["host"])


def test_the_link_budget_counts_the_hidden_state_only_where_there_is_one() -> None:
    target = TARGETS["atmega328p"]
    plans = [render_context(d, target).link for d in (design(), all_parameters("roll"))]
    plans.append(render_context(all_parameters(), target).link)
    assert [plan.bytes_per_s - plans[0].bytes_per_s for plan in plans] == [0, 400, 800]
    # 100 samples of 43 + 12 bytes, 50 attitudes of 28 + 12, a status of 43 + 12, a heartbeat of 21.
    assert plans[0].bytes_per_s == 100 * 55 + 50 * 40 + 55 + 21


def test_more_hidden_state_than_a_message_carries_is_refused() -> None:
    with pytest.raises(RenderError, match=r"has 25 words of state .* carries 24"):
        link_plan(100.0, TARGETS["host"], hidden_words=25)


def test_the_dialect_has_the_hidden_words_that_the_link_plan_counts_on() -> None:
    message = python_module().MAVLink_tilt_sample_message
    field = message.ordered_fieldnames.index("hidden")
    assert field == len(message.ordered_fieldnames) - 1
    assert message.array_lengths[field] == HIDDEN_WORDS == SAMPLE_HIDDEN_WORDS
    assert python_module().MAVLink_tilt_state_message.array_lengths == [0, STATE_WORDS]


def test_link_that_is_too_slow_is_refused_with_the_budget() -> None:
    with pytest.raises(RenderError, match=r"500000 baud .* a design of about \d+ Hz"):
        generate(design(rate_hz=1000.0, low_pass_setting=1), TARGETS["atmega328p"])
