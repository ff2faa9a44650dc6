import os
from pathlib import Path

import pytest

from hostkit.errors import HostkitError
from hostkit.files import write_aside


def names(folder: Path) -> list[str]:
    return [path.name for path in folder.iterdir()]


def test_writes_bytes_and_text_as_they_are(tmp_path: Path) -> None:
    write_aside(tmp_path / "a.bin", b"\r\n\x00")
    write_aside(tmp_path / "a.txt", "a\nµ\r\n")
    assert (tmp_path / "a.bin").read_bytes() == b"\r\n\x00"
    assert (tmp_path / "a.txt").read_bytes() == "a\nµ\r\n".encode()


def test_replaces_a_file_and_leaves_nothing_else(tmp_path: Path) -> None:
    target = tmp_path / "a.txt"
    target.write_text("old")
    target.chmod(0o640)
    write_aside(target, "new")
    assert target.read_text() == "new"
    assert target.stat().st_mode & 0o777 == 0o640
    assert names(tmp_path) == ["a.txt"]


def test_new_file_has_the_permissions_of_a_plain_one(tmp_path: Path) -> None:
    (tmp_path / "plain").write_text("")
    write_aside(tmp_path / "aside", "")
    assert (tmp_path / "aside").stat().st_mode == (tmp_path / "plain").stat().st_mode


def test_missing_folder_is_named(tmp_path: Path) -> None:
    with pytest.raises(HostkitError, match=r"missing/a\.txt cannot be written: No such file"):
        write_aside(tmp_path / "missing" / "a.txt", "text")


def test_full_disk_keeps_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target = tmp_path / "a.txt"
    target.write_text("old")

    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(HostkitError, match="No space left on device"):
        write_aside(target, "new")
    assert target.read_text() == "old"
    assert names(tmp_path) == ["a.txt"]


def test_folder_in_the_way_leaves_no_temporary_file(tmp_path: Path) -> None:
    (tmp_path / "a.txt").mkdir()
    with pytest.raises(HostkitError, match=r"a\.txt cannot be written"):
        write_aside(tmp_path / "a.txt", "text")
    assert names(tmp_path) == ["a.txt"]


def test_symbolic_link_is_followed(tmp_path: Path) -> None:
    (tmp_path / "real.txt").write_text("old")
    (tmp_path / "link.txt").symlink_to(tmp_path / "real.txt")
    write_aside(tmp_path / "link.txt", "new")
    assert (tmp_path / "link.txt").is_symlink()
    assert (tmp_path / "real.txt").read_text() == "new"


def test_a_device_is_written_to_and_stays_a_device(tmp_path: Path) -> None:
    """A rename would put a file in the place of the device."""
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    write_aside(pipe, "through")
    assert os.read(reader, 100) == b"through"
    os.close(reader)
    assert pipe.is_fifo()
    assert [p.name for p in tmp_path.iterdir()] == ["pipe"]
    write_aside(Path("/dev/null"), "nothing")
    assert Path("/dev/null").is_char_device()
    with pytest.raises(HostkitError, match="No space left"):
        write_aside(Path("/dev/full"), "too much")


@pytest.mark.parametrize("step", ["chmod", "replace"])
def test_an_interrupt_at_any_step_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, step: str
) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(Path, step, interrupted)
    with pytest.raises(KeyboardInterrupt):
        write_aside(tmp_path / "design.json", "{}")
    assert list(tmp_path.iterdir()) == []
