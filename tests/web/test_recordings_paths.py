import os
from pathlib import Path

import pytest
from served import App, make_app

from hostkit.web import files

BAD_NAMES = (
    "../a.tlog",
    "..",
    ".",
    ".hidden.tlog",
    "a/b.tlog",
    "a\\b.tlog",
    "/etc/a.tlog",
    "a.tlog\0.csv",
    "a b.tlog",
    "a.tlog\n",
    "\u00e4.tlog",
    "a.txt",
    "a",
    "",
    ".tlog",
    "a" * 76 + ".tlog",
    "C:a.tlog",
)


@pytest.fixture
def app(tmp_path: Path) -> App:
    folder = tmp_path / "recordings"
    folder.mkdir()
    (tmp_path / "outside.tlog").write_bytes(b"secret")
    return make_app(folder)


def test_folder_is_listed(app: App) -> None:
    (app.folder / "b.tlog").write_bytes(b"12345")
    (app.folder / "a.npz").write_bytes(b"1")
    (app.folder / "note.txt").write_bytes(b"not a recording")
    (app.folder / "folder.csv").mkdir()
    (app.folder / "link.csv").symlink_to(app.folder.parent / "outside.tlog")
    listed = app.get("/api/recordings").json()
    assert listed == [{"name": "a.npz", "bytes": 1}, {"name": "b.tlog", "bytes": 5}]


def test_folder_that_is_gone_is_empty(app: App) -> None:
    app.folder.rmdir()
    assert app.get("/api/recordings").json() == []


def test_recording_is_downloaded(app: App) -> None:
    content = os.urandom(3 * files.CHUNK_BYTES + 17)
    (app.folder / "b.tlog").write_bytes(content)
    reply = app.get("/recordings/b.tlog")
    assert (reply.status, reply.body) == (200, content)
    assert reply.headers["content-disposition"] == 'attachment; filename="b.tlog"'
    assert reply.headers["content-type"] == "application/octet-stream"


def test_recording_that_grows_is_given_as_far_as_it_was(app: App) -> None:
    path = app.folder / "b.tlog"
    path.write_bytes(b"a" * 10)
    opened = files.open_recording(app.folder, "b.tlog")
    assert opened is not None
    given = files.chunks(opened)
    first = next(given)
    with path.open("ab") as more:
        more.write(b"b" * 10)
    assert first + b"".join(given) == b"a" * 10
    assert opened.closed


@pytest.mark.parametrize("name", BAD_NAMES)
def test_bad_names_are_not_found(app: App, name: str) -> None:
    reply = app.get(f"/recordings/{name}")
    assert reply.status == 404
    assert b"secret" not in reply.body


def test_links_pipes_and_folders_are_not_given(app: App) -> None:
    (app.folder / "link.tlog").symlink_to(app.folder.parent / "outside.tlog")
    (app.folder / "inner.tlog").symlink_to("link.tlog")
    (app.folder / "folder.tlog").mkdir()
    os.mkfifo(app.folder / "pipe.tlog")
    for name in ("link.tlog", "inner.tlog", "folder.tlog", "pipe.tlog", "none.tlog"):
        assert app.get(f"/recordings/{name}").status == 404


@pytest.mark.parametrize("name", BAD_NAMES)
def test_no_recording_of_a_bad_name(app: App, name: str) -> None:
    reply = app.post("/api/recording", {"action": "start", "name": name})
    assert reply.status == 400
    assert app.controls.calls == []


@pytest.mark.parametrize("name", ["a.tlog", "a.csv", "a.npz", "A-1_2.3.tlog", "a" * 75 + ".tlog"])
def test_recording_of_a_good_name(app: App, name: str) -> None:
    assert app.post("/api/recording", {"action": "start", "name": name}).status == 202
    assert (app.folder / name).is_file()


def test_no_recording_over_an_existing_file(app: App) -> None:
    (app.folder / "a.tlog").write_bytes(b"kept")
    (app.folder / "dangling.tlog").symlink_to("nowhere")
    for name in ("a.tlog", "dangling.tlog"):
        reply = app.post("/api/recording", {"action": "start", "name": name})
        assert reply.status == 409
        assert "exists" in reply.json()["error"]
    assert app.controls.calls == []
