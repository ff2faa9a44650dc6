import json
from dataclasses import replace
from pathlib import Path

import pytest
from designs import design
from hypothesis import given, settings
from hypothesis import strategies as st

from hostkit.design_file import (
    design_text,
    digest,
    edited_by_hand,
    from_document,
    load_design,
    save_design,
    to_document,
)
from hostkit.errors import DesignError
from hostkit.filters.complementary import parameters
from hostkit.records import RecordingDigest, TuningRecord

TUNING = TuningRecord(
    objective="mae",
    optimiser="qpso",
    seed=1,
    particles=20,
    iterations=100,
    evaluations=2020,
    rmse_deg=1.25,
    recordings=(RecordingDigest(name="a", sha256="0" * 64, samples=10),),
    versions=(("hostkit", "0"),),
)


def test_design_survives_its_file(tmp_path: Path) -> None:
    path = tmp_path / "design.json"
    wanted = replace(design(mounting="+z+x+y", eta=0.1 + 0.2), tuning=TUNING)
    save_design(wanted, path)
    assert load_design(path) == wanted
    assert not edited_by_hand(path)
    assert json.loads(path.read_text())["digest"] == digest(wanted)


def test_digest_names_the_content() -> None:
    assert digest(design()) == digest(design())
    assert digest(design()) != digest(design(eta=0.99650001))
    assert len(digest(design())) == 12


def test_an_edited_design_is_another_design(tmp_path: Path) -> None:
    path = tmp_path / "design.json"
    save_design(design(), path)
    path.write_text(path.read_text().replace("0.9965", "0.9964"))
    assert edited_by_hand(path)
    assert digest(load_design(path)) == digest(design(eta=0.9964))


HOSTILE = {
    "filter": ["complementary; rm -rf /", "../x", "", "a\nb", 3, None, "complementary */ x"],
    "axes": ["yaw", "both\n", ["roll"], None],
    "tilt": ["atan", {}],
    "mounting": ["+x+y-z", "*/int x;", 7],
    "rate_hz": ["100", True, 0, -1, 1e9, 10**400, -(10**400), None, [100]],
    "sensor": [{}, None, "mpu6050"],
    "parameters": [
        None,
        [],
        {"eta": 0.5},
        {"e ta": {"value": 1, "unit": "1"}},
        {"eta": {"value": "x", "unit": "1"}},
    ],
    "tuning": [{}, [], "none"],
    "schema": ["hostkit.design/2", None],
    "extra": [1],
}


@pytest.mark.parametrize(("key", "value"), [(k, v) for k, vs in HOSTILE.items() for v in vs])
def test_hostile_value_is_refused_by_name(key: str, value: object) -> None:
    document = {**to_document(design()), key: value}
    with pytest.raises(DesignError) as refusal:
        from_document(document)
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize("key", ["part", "gyro_full_scale_deg_s", "low_pass_setting"])
def test_hostile_sensor_value_is_refused(key: str) -> None:
    document = to_document(design())
    document["sensor"][key] = "2; #include"
    with pytest.raises(DesignError, match=key):
        from_document(document)


@pytest.mark.parametrize(
    "text", ["", "{", "[]", "null", '{"eta": NaN}', "\ud83d\ude00", "[" * 100_000]
)
def test_what_is_not_a_design_is_refused(text: str, tmp_path: Path) -> None:
    path = tmp_path / "design.json"
    path.write_bytes(text.encode("utf-8", "surrogatepass"))
    with pytest.raises(DesignError):
        load_design(path)


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=20),
    lambda inner: (
        st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=8), inner, max_size=3)
    ),
    max_leaves=8,
)


@settings(max_examples=200)
@given(st.sampled_from(sorted(to_document(design()))), JSON)
def test_any_json_is_read_or_refused(key: str, value: object) -> None:
    try:
        found = from_document({**to_document(design()), key: value})
    except DesignError:
        return
    assert from_document(json.loads(design_text(found))) == found


def test_unit_of_a_parameter_never_reaches_code() -> None:
    from hostkit.render import render_target
    from hostkit.targets import TARGETS

    evil = replace(parameters(0.9965)[0], unit='*/ int evil; "')
    poisoned = replace(design(), parameters=(evil,))
    for target in TARGETS:
        assert not any("evil" in file.content for file in render_target(poisoned, target))
