from pathlib import Path

import pytest

from hostkit.errors import RecordingError
from hostkit.fleet.discovery import find_devices

NOWHERE = Path("/nowhere")


def touch(folder: Path, *names: str) -> Path:
    for name in names:
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    return folder


def found(folder: Path, group_by: str = "folder") -> dict[str, list[str]]:
    devices = find_devices(folder, group_by, leave_out=NOWHERE)
    return {device.name: [path.name for path in device.files] for device in devices}


def test_a_sub_folder_is_a_device(tmp_path: Path) -> None:
    touch(tmp_path, "b/2.csv", "b/1.NPZ", "a/x.csv", "a/notes.txt", "a/.hidden.csv", "a/old/y.csv")
    touch(tmp_path, ".git/z.csv", "readme.md")
    assert found(tmp_path) == {"a": ["x.csv"], "b": ["1.NPZ", "2.csv"]}
    assert list(found(tmp_path)) == ["a", "b"]


def test_a_prefix_is_a_device(tmp_path: Path) -> None:
    touch(tmp_path, "b_2.csv", "b_1_x.npz", "a.csv", "_c.csv", "sub/d.csv", "e_1.txt")
    assert found(tmp_path, "prefix") == {
        "_c": ["_c.csv"],
        "a": ["a.csv"],
        "b": ["b_1_x.npz", "b_2.csv"],
    }


def test_the_output_folder_is_no_device(tmp_path: Path) -> None:
    touch(tmp_path, "a/x.csv", "designs/a.json")
    devices = find_devices(tmp_path, "folder", leave_out=tmp_path / "designs")
    assert [device.name for device in devices] == ["a"]


def test_recordings_outside_of_folders_are_not_left_out_in_silence(tmp_path: Path) -> None:
    touch(tmp_path, "a/x.csv", "stray.csv", "other.csv")
    with pytest.raises(RecordingError, match=r"2 recording\(s\) outside.*'other\.csv'.*prefix"):
        found(tmp_path)


@pytest.mark.parametrize("group_by", ["folder", "prefix"])
def test_no_device_at_all(tmp_path: Path, group_by: str) -> None:
    with pytest.raises(RecordingError, match=f"no device; grouped by {group_by}"):
        found(tmp_path, group_by)
    with pytest.raises(RecordingError, match="cannot be read: No such file"):
        found(tmp_path / "missing", group_by)


def test_what_cannot_be_a_device_says_why(tmp_path: Path) -> None:
    touch(tmp_path, "Fleet/x.csv", "line\nbreak/x.csv", "n" * 201 + "/x.csv", "good/x.csv")
    (tmp_path / "empty").mkdir()
    faults = {d.name: d.fault for d in find_devices(tmp_path, "folder", leave_out=NOWHERE)}
    assert faults.pop("good") == ""
    assert "fleet.json is the summary" in faults.pop("Fleet")
    assert faults.pop("empty") == "its folder holds no recording (.csv or .npz)"
    assert all("cannot name a file" in fault for fault in faults.values())
    assert len(faults) == 2


def test_a_pipe_is_not_waited_for(tmp_path: Path) -> None:
    import os

    touch(tmp_path, "a/x.csv")
    os.mkfifo(tmp_path / "a" / "pipe.csv")
    assert found(tmp_path) == {"a": ["x.csv"]}


def test_thousands_of_files_are_found_without_opening_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for i in range(300):
        touch(tmp_path, *(f"d{i:03}/{j}.csv" for j in range(10)))

    def refuse(*arguments: object, **options: object) -> None:
        raise AssertionError("a recording was opened")

    monkeypatch.setattr("pathlib.Path.open", refuse)
    monkeypatch.setattr("builtins.open", refuse)
    devices = find_devices(tmp_path, "folder", leave_out=NOWHERE)
    monkeypatch.undo()
    assert sum(len(device.files) for device in devices) == 3000
    assert [device.name for device in devices] == [f"d{i:03}" for i in range(300)]
