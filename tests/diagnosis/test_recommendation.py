import pytest
from diagnosis_cases import made, simulated

from hostkit.diagnosis import (
    diagnose,
    findings,
    recommended_filter,
    recommended_for_all,
    to_document,
)


def of(profile: str, axes: str = "both"):
    return diagnose(simulated(profile), axes=axes)


def test_planar_motion_calls_for_the_complementary_filter() -> None:
    found = recommended_filter(of("planar", "roll"))
    assert found is not None
    assert found.filter == "complementary"
    assert found.reason.startswith("roll by itself holds this motion")


def test_free_motion_calls_for_the_observer() -> None:
    found = recommended_filter(of("free"))
    assert found is not None
    assert found.filter == "observer"
    assert "no eta mends that" in found.reason


def test_without_motion_nothing_is_recommended() -> None:
    still = diagnose(made())
    assert recommended_filter(still) is None
    assert recommended_for_all((still, still)) is None
    (entry,) = to_document((("still.csv", still),))["recordings"]
    assert entry["recommended_filter"] is None
    assert entry["recommended_because"] is None


def test_one_recording_in_three_dimensions_decides_for_all() -> None:
    planar, free = of("planar"), of("free")
    together = recommended_for_all((planar, free, diagnose(made())))
    assert together is not None
    assert together.filter == "observer"
    assert together.reason.startswith("1 of 2 recordings")
    assert recommended_for_all((planar,)) == recommended_filter(planar)


@pytest.mark.parametrize(("profile", "name"), [("planar", "complementary"), ("free", "observer")])
def test_document_names_filter_and_reason(profile: str, name: str) -> None:
    (entry,) = to_document((("a.csv", of(profile)),))["recordings"]
    assert entry["recommended_filter"] == name
    assert entry["recommended_because"]


def test_the_line_on_motion_names_the_option() -> None:
    motion = next(f for f in findings(of("free")) if f.topic == "motion")
    assert "--filter observer" in motion.action
