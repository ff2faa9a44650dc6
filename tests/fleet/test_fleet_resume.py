import json
from dataclasses import replace
from pathlib import Path

import pytest
from fleet_work import QUICK, Inline, edit, files_of, recorded, run_fleet, spoil

from hostkit.errors import HostkitError
from hostkit.fleet import FleetOptions, FleetResult, SensorWish
from hostkit.fleet.journal import STATE, open_journal
from hostkit.recordings import save


def statuses(result: FleetResult) -> str:
    return " ".join(device.status for device in result.devices)


@pytest.fixture
def tuned(fleet: Path, tmp_path: Path) -> Path:
    output = tmp_path / "out"
    assert statuses(run_fleet(fleet, output, Inline())) == "ok ok ok ok"
    return output


def again(fleet: Path, output: Path, **changes: object) -> tuple[str, list[str]]:
    """Run once more; gives the statuses and the devices that were tuned."""
    workers = Inline()
    result = run_fleet(fleet, output, workers, options=FleetOptions(**{"tuning": QUICK, **changes}))
    return statuses(result), workers.given


def test_what_is_unchanged_is_skipped_with_its_figures(fleet: Path, tuned: Path) -> None:
    first = json.loads((tuned / "fleet.json").read_text())["devices"]
    before = files_of(tuned)
    assert again(fleet, tuned) == ("skipped skipped skipped skipped", [])
    second = json.loads((tuned / "fleet.json").read_text())["devices"]
    assert [{**device, "status": "ok"} for device in second] == first
    assert {**files_of(tuned), "fleet.json": b""} == {**before, "fleet.json": b""}


def test_a_changed_recording_is_tuned_again(fleet: Path, tuned: Path) -> None:
    save(recorded(999), fleet / "dev001" / "run1.npz")
    assert again(fleet, tuned) == ("skipped ok skipped skipped", ["dev001"])
    assert again(fleet, tuned)[1] == []


def test_a_recording_more_or_less_or_renamed_is_a_change(fleet: Path, tuned: Path) -> None:
    save(recorded(5), fleet / "dev000" / "more.npz")
    (fleet / "dev001" / "run1.npz").unlink()
    (fleet / "dev002" / "run0.npz").rename(fleet / "dev002" / "other.npz")
    assert again(fleet, tuned) == ("ok ok ok skipped", ["dev000", "dev001", "dev002"])


@pytest.mark.parametrize(
    "change",
    [
        {"tuning": replace(QUICK, seed=2)},
        {"tuning": replace(QUICK, objective="mae")},
        {"wish": SensorWish(gyro_full_scale_deg_s=2000)},
    ],
    ids=["seed", "objective", "range"],
)
def test_other_options_tune_everything_again(fleet: Path, tuned: Path, change) -> None:
    assert again(fleet, tuned, **change)[0] == "ok ok ok ok"
    assert again(fleet, tuned, **change)[0] == "skipped skipped skipped skipped"


def test_the_wished_range_is_that_of_every_design(fleet: Path, tuned: Path) -> None:
    again(fleet, tuned, wish=SensorWish(gyro_full_scale_deg_s=2000, low_pass_setting=5))
    for name in ("dev000", "dev003"):
        sensor = json.loads((tuned / f"{name}.json").read_text())["sensor"]
        assert (sensor["gyro_full_scale_deg_s"], sensor["low_pass_setting"]) == (2000, 5)


def test_a_missing_design_is_made_again_and_redo_makes_all(fleet: Path, tuned: Path) -> None:
    before = files_of(tuned)
    (tuned / "dev003.json").unlink()
    assert again(fleet, tuned)[1] == ["dev003"]
    assert again(fleet, tuned, redo=True)[0] == "ok ok ok ok"
    assert files_of(tuned) == before


def test_a_design_edited_by_hand_is_kept_and_told(fleet: Path, tuned: Path) -> None:
    """Also where the editor mended the digest, or the recordings changed as well."""
    edited = edit(tuned / "dev001.json")
    save(recorded(999), fleet / "dev001" / "run0.npz")
    path = tuned / "dev002.json"
    path.write_text(path.read_text().replace('"rate_hz": 100.0', '"rate_hz": 99.9'))
    (tuned / "dev003.json").write_text("{")
    kept = files_of(tuned)
    workers = Inline()
    result = run_fleet(fleet, tuned, workers)
    assert (statuses(result), workers.given) == ("skipped failed failed failed", [])
    assert f"dev001.json was edited since it was tuned, it is now design {edited}" in (
        result.devices[1].error
    )
    assert "was edited" in result.devices[2].error
    assert "is not JSON" in result.devices[3].error
    assert {**files_of(tuned), "fleet.json": b""} == {**kept, "fleet.json": b""}
    assert again(fleet, tuned, redo=True)[0] == "ok ok ok ok"


def test_an_edit_shows_even_where_the_state_is_lost(fleet: Path, tuned: Path) -> None:
    (tuned / STATE).unlink()
    path = tuned / "dev002.json"
    path.write_text(path.read_text().replace('"rate_hz": 100.0', '"rate_hz": 99.9'))
    assert again(fleet, tuned) == ("ok ok failed ok", ["dev000", "dev001", "dev003"])


def test_a_run_that_ended_before_the_design_was_renamed(fleet: Path, tuned: Path) -> None:
    """The state names a design that never came to be; the old one is still hostkit's own."""
    save(recorded(999), fleet / "dev001" / "run1.npz")
    old = (tuned / "dev001.json").read_bytes()
    again(fleet, tuned)
    for _ in range(2):  # The second time from a state that was tidied on opening.
        (tuned / "dev001.json").write_bytes(old)
        assert again(fleet, tuned) == ("skipped ok skipped skipped", ["dev001"])


def test_a_torn_line_of_the_state_costs_one_device(fleet: Path, tuned: Path) -> None:
    state = tuned / STATE
    text = state.read_text()
    state.write_text(
        text[:-9] + "\nnonsense\n[]\n" + '{"device": 1, "digest": 2, "fingerprint": 3}\n'
    )
    status, given = again(fleet, tuned)
    assert (status.split().count("ok"), len(given)) == (1, 1)
    assert sorted(state.read_text().splitlines()) == sorted(text.splitlines())


def test_a_failed_device_is_tried_again_and_keeps_the_design_it_had(
    fleet: Path, tuned: Path
) -> None:
    before = (tuned / "dev000.json").read_bytes()
    spoil(fleet, "dev000")
    for _ in range(2):
        assert again(fleet, tuned) == ("failed skipped skipped skipped", ["dev000"])
    assert (tuned / "dev000.json").read_bytes() == before
    device = json.loads((tuned / "fleet.json").read_text())["devices"][0]
    assert device["digest"] is device["eta"] is device["rmse_deg"] is None


def test_left_overs_of_a_killed_run_are_removed_and_others_are_not(
    fleet: Path, tuned: Path
) -> None:
    (tuned / ".dev000.json.abc.part").write_text("{")
    (tuned / "mine.part").touch()
    again(fleet, tuned)
    assert [path.name for path in tuned.glob("*.part")] == ["mine.part"]


def test_one_run_at_a_time_may_write(fleet: Path, tuned: Path) -> None:
    with open_journal(tuned), pytest.raises(HostkitError, match="another run is writing"):
        again(fleet, tuned)
    assert again(fleet, tuned)[1] == []


def test_there_is_no_summary_while_a_run_is_under_way(fleet: Path, tuned: Path) -> None:
    def interrupt(step: object) -> None:
        assert not (tuned / "fleet.json").exists()
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run_fleet(fleet, tuned, Inline(), watch=interrupt)
    assert not (tuned / "fleet.json").exists()


def test_output_that_cannot_be_made(fleet: Path, tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(HostkitError, match="cannot be used as output folder: File"):
        run_fleet(fleet, tmp_path / "file", Inline())
