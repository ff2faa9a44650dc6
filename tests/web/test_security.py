import logging
from pathlib import Path

import pytest
from served import HOST, JSON, PORT, App, make_app

from hostkit.web.security import access, host_name

POSTS = {
    "/api/parameters": {"name": "FILT_TAU", "value": 0.5},
    "/api/parameters/revert": {},
    "/api/command": {"name": "calibrate"},
    "/api/recording": {"action": "start", "name": "a.tlog"},
    "/api/port": {"action": "release"},
    "/api/verdict": {"action": "restart"},
    "/api/replay": {"action": "pause"},
}
GETS = (
    "/",
    "/page/page.js",
    "/vendor/uPlot.esm.js",
    "/api/session",
    "/api/recordings",
    "/recordings/a.tlog",
    "/report.html",
    "/report.json",
    "/report.xml",
    "/stream",
)


@pytest.fixture
def app(tmp_path: Path) -> App:
    return make_app(tmp_path, replayed=True)


def test_token_is_exchanged_for_a_cookie(app: App) -> None:
    reply = app.ask("GET", f"/?token={app.access.token}", headers={"host": HOST})
    assert (reply.status, reply.headers["location"]) == (303, "/")
    cookie, *attributes = reply.headers["set-cookie"].split("; ")
    assert cookie == f"hostkit-{PORT}={app.access.cookie}"
    assert set(attributes) == {"HttpOnly", "SameSite=Strict", "Path=/"}
    assert app.access.token not in str(reply)
    assert app.ask("GET", "/api/session", headers={"host": HOST, "cookie": cookie}).status == 200


@pytest.mark.parametrize("token", ["", "x", "%C3%A9%FF", "None"])
def test_wrong_token_gives_no_cookie(app: App, token: str) -> None:
    reply = app.ask("GET", f"/?token={token}", headers={"host": HOST})
    assert reply.status == 401
    assert "set-cookie" not in reply.headers


@pytest.mark.parametrize("path", GETS)
def test_without_the_cookie_nothing_is_given(app: App, path: str) -> None:
    assert app.ask("GET", path, headers={"host": HOST}).status == 401
    token = {"host": HOST, "cookie": f"hostkit-{PORT}={app.access.token}"}
    assert app.ask("GET", path, headers=token).status == 401
    other_port = {"host": HOST, "cookie": f"hostkit-1={app.access.cookie}"}
    assert app.ask("GET", path, headers=other_port).status == 401


@pytest.mark.parametrize(("path", "body"), POSTS.items())
def test_post_needs_cookie_and_header(app: App, path: str, body: object) -> None:
    assert app.post(path, body).status == 202
    app.controls.calls.clear()
    assert app.post(path, body, {"cookie": ""}).status == 401
    assert app.post(path, body, {"x-hostkit-token": ""}).status == 403
    assert app.post(path, body, {"x-hostkit-token": app.access.token}).status == 403
    assert app.post(path, body, {"x-hostkit-token": "\xe9"}).status == 403
    assert app.controls.calls == []


@pytest.mark.parametrize("path", POSTS)
def test_a_post_path_cannot_be_had_by_get(app: App, path: str) -> None:
    assert app.get(path).status == 405
    assert app.controls.calls == []


@pytest.mark.parametrize("path", GETS)
def test_a_get_path_cannot_be_posted_to(app: App, path: str) -> None:
    assert app.post(path, {}).status == 405


@pytest.mark.parametrize(
    "host",
    ["evil.example", f"evil.example:{PORT}", "127.0.0.1.evil.example", "127.0.0.2", "", "[::2]"],
)
def test_other_names_are_refused(app: App, host: str) -> None:
    assert app.get("/api/session", host=host).status == 421
    signing_in = app.ask("GET", f"/?token={app.access.token}", headers={"host": host})
    assert signing_in.status == 421


@pytest.mark.parametrize(
    "host", [HOST, f"localhost:{PORT}", f"LOCALHOST:{PORT}", f"[::1]:{PORT}", "localhost:9000"]
)
def test_names_of_loopback_are_known_at_any_port(app: App, host: str) -> None:
    # A tunnel may have another port at its near end.
    assert app.get("/api/session", host=host).status == 200


def test_no_host_or_two_are_refused(app: App) -> None:
    cookie = ("cookie", app.signed_in()["cookie"])
    assert app.ask("GET", "/api/session", headers=[cookie]).status == 400
    two = [cookie, ("host", HOST), ("host", HOST)]
    assert app.ask("GET", "/api/session", headers=two).status == 400


def test_further_hosts_can_be_allowed(tmp_path: Path) -> None:
    app = make_app(tmp_path, hosts=("Pi.local",))
    assert app.get("/api/session", host=f"pi.local:{PORT}").status == 200
    assert app.get("/api/session", host=f"pi2.local:{PORT}").status == 421


@pytest.mark.parametrize(
    "origin", ["null", "http://evil.example", f"http://localhost:{PORT}", "http://127.0.0.1:1", ""]
)
@pytest.mark.parametrize("path", ["/api/session", "/stream", "/"])
def test_foreign_origin_is_refused(app: App, origin: str, path: str) -> None:
    assert app.get(path, origin=origin).status == 403
    assert app.post("/api/verdict", {"action": "restart"}, {"origin": origin}).status == 403
    assert app.controls.calls == []


def test_own_origin_is_accepted(app: App) -> None:
    own = {"origin": f"http://{HOST}"}
    assert app.post("/api/verdict", {"action": "restart"}, own).status == 202


@pytest.mark.parametrize("site", ["cross-site", "same-site", "nonsense"])
def test_requests_of_another_site_are_refused(app: App, site: str) -> None:
    assert app.get("/stream", **{"sec-fetch-site": site}).status == 403
    link = app.ask(
        "GET",
        f"/?token={app.access.token}",
        headers={"host": HOST, "sec-fetch-site": site},
    )
    assert link.status == 303


@pytest.mark.parametrize("path", ["/", "/api/session", "/nowhere", "/report.html", "/stream"])
@pytest.mark.parametrize("signed_in", [True, False])
def test_every_answer_carries_the_headers(app: App, path: str, signed_in: bool) -> None:
    headers = app.signed_in() if signed_in else {"host": HOST}
    reply = app.ask("GET", path, headers=headers)
    policy = reply.headers["content-security-policy"]
    assert "default-src 'self'" in policy
    assert "frame-ancestors 'none'" in policy
    assert "unsafe" not in policy
    assert reply.headers["x-content-type-options"] == "nosniff"
    assert reply.headers["referrer-policy"] == "no-referrer"
    assert reply.headers["cache-control"] in ("no-store", "no-cache")
    assert "access-control-allow-origin" not in reply.headers


def test_a_failure_is_told_without_its_traceback(
    app: App, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def fails(self: object) -> None:
        raise ValueError("a secret detail")

    monkeypatch.setattr(type(app.controls), "info", fails)
    with caplog.at_level(logging.DEBUG):
        reply = app.ask("GET", "/api/session?token=T", headers=app.signed_in())
    assert reply.status == 500
    assert b"secret detail" not in reply.body
    assert "a secret detail" in caplog.text
    for secret in (app.access.token, app.access.cookie, app.access.csrf):
        assert secret not in caplog.text


def test_secrets_are_long_differ_and_are_not_shown() -> None:
    first, second = access(1), access(1)
    secrets = {first.token, first.cookie, first.csrf, second.token, second.cookie, second.csrf}
    assert len(secrets) == 6
    assert all(len(secret) >= 43 for secret in secrets)
    assert not any(secret in repr(first) + repr(second) for secret in secrets)


def test_session_gives_no_secret_but_the_csrf(app: App) -> None:
    reply = app.get("/api/session")
    assert reply.json()["csrf"] == app.access.csrf
    assert app.access.cookie not in reply.body.decode()
    assert app.access.token not in reply.body.decode()


@pytest.mark.parametrize(
    ("host", "name"),
    [("a", "a"), ("A:1", "a"), ("[::1]", "[::1]"), ("[::1]:80", "[::1]"), ("a:", "a:"), ("", "")],
)
def test_host_name(host: str, name: str) -> None:
    assert host_name(host) == name


def test_content_type_must_be_json(app: App) -> None:
    for kind in ("text/plain", "", "application/x-www-form-urlencoded", "multipart/form-data"):
        reply = app.post("/api/verdict", {"action": "restart"}, {"content-type": kind})
        assert reply.status == 415
    charset = {"content-type": "application/json; charset=utf-8"}
    assert app.post("/api/verdict", {"action": "restart"}, charset).status == 202
    assert JSON["content-type"] == "application/json"
