"""Who may talk to the server: checks of every request, and headers of every answer."""

import hmac
import ipaddress
import logging
import secrets
from collections.abc import Iterable
from dataclasses import dataclass, field

from starlette.datastructures import Headers, MutableHeaders, QueryParams
from starlette.requests import cookie_parser
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from hostkit.web.answers import failure, redirect

LOOPBACK_NAMES = ("127.0.0.1", "localhost", "[::1]")
CSRF_HEADER = "x-hostkit-token"
HEADERS = {
    "Content-Security-Policy": (
        "default-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'; "
        "object-src 'none'"
    ),
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
}
SAME_SITE = ("same-origin", "none")

log = logging.getLogger("hostkit.web")


def _secret() -> str:
    return secrets.token_urlsafe(32)


@dataclass(frozen=True, slots=True, kw_only=True)
class Access:
    """The secrets of one server; none is ever shown.

    Attributes
    ----------
    token
        In the address that is printed; it is exchanged for the cookie.
    cookie
        What every request needs.
    csrf
        What every request that changes something needs in a header, which no form or image of a
        foreign page can set.
    hosts
        Names, without a port, under which the server may be addressed.
    any_address
        Whether addresses in numbers are as good as those names. They cannot be rebound by DNS.
    """

    cookie_name: str
    hosts: frozenset[str]
    any_address: bool = False
    token: str = field(default_factory=_secret, repr=False)
    cookie: str = field(default_factory=_secret, repr=False)
    csrf: str = field(default_factory=_secret, repr=False)


def access(port: int, hosts: Iterable[str] = (), *, any_address: bool = False) -> Access:
    """Return new secrets for a server at `port`; `hosts` are names beside those of loopback."""
    names = frozenset(name.lower() for name in (*LOOPBACK_NAMES, *hosts))
    return Access(cookie_name=f"hostkit-{port}", hosts=names, any_address=any_address)


def same(left: str, right: str) -> bool:
    """Compare secrets in a time that does not tell how far they agree."""
    return hmac.compare_digest(left.encode("utf-8", "replace"), right.encode("utf-8", "replace"))


def host_name(host: str) -> str:
    """Return a Host header without its port, in lower case."""
    name, colon, port = host.rpartition(":")
    return (name if colon and port.isascii() and port.isdigit() else host).lower()


def is_address(name: str) -> bool:
    """Return whether a host is an IPv4 address, or an IPv6 address in brackets."""
    bracketed = name.startswith("[") and name.endswith("]")
    kind = ipaddress.IPv6Address if bracketed else ipaddress.IPv4Address
    try:
        kind(name[1:-1] if bracketed else name)
    except ValueError:
        return False
    return True


class Guard:
    """Lets a request through to the application only if it may, and marks every answer."""

    def __init__(self, app: ASGIApp, rights: Access) -> None:
        self._app = app
        self._access = rights

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one request."""
        if scope["type"] != "http":
            return
        started = False

        async def marked(message: Message) -> None:
            nonlocal started
            if message["type"] == "http.response.start":
                started = True
                headers = MutableHeaders(scope=message)
                headers.update(HEADERS)
                headers.setdefault("Cache-Control", "no-store")
            await send(message)

        try:
            await (self._refusal(scope) or self._app)(scope, receive, marked)
        except Exception:
            log.exception("the page's server failed on %s", scope["method"])
            if not started:
                await failure(500, "the server failed; its terminal says why")(
                    scope, receive, marked
                )

    def _refusal(self, scope: Scope) -> ASGIApp | None:
        headers = Headers(scope=scope)
        return (
            self._foreign_host(headers)
            or self._foreign_origin(scope, headers)
            or self._sign_in(scope)
            or self._no_cookie(headers)
            or self._no_csrf(scope, headers)
        )

    def _foreign_host(self, headers: Headers) -> ASGIApp | None:
        hosts = headers.getlist("host")
        if len(hosts) != 1:
            return failure(400, "one Host header is needed")
        name = host_name(hosts[0])
        if name in self._access.hosts or (self._access.any_address and is_address(name)):
            return None
        return failure(421, "not a name of this server; --web-allow-host NAME adds one")

    def _foreign_origin(self, scope: Scope, headers: Headers) -> ASGIApp | None:
        host = headers["host"].lower()
        own = (f"http://{host}", f"https://{host}")
        if any(origin.lower() not in own for origin in headers.getlist("origin")):
            return failure(403, "requests of another origin are refused")
        # A link to the page may be followed from anywhere; it shows nothing to its origin.
        opened = scope["method"] == "GET" and scope["path"] == "/"
        if not opened and headers.get("sec-fetch-site", "none") not in SAME_SITE:
            return failure(403, "requests of another site are refused")
        return None

    def _sign_in(self, scope: Scope) -> ASGIApp | None:
        if scope["method"] != "GET" or scope["path"] != "/":
            return None
        given = QueryParams(scope["query_string"]).get("token")
        if given is None:
            return None
        if not same(given, self._access.token):
            return failure(401, "the token is wrong; open the address that hostkit printed")
        cookie = f"{self._access.cookie_name}={self._access.cookie}"
        return redirect("/", f"{cookie}; HttpOnly; SameSite=Strict; Path=/")

    def _no_cookie(self, headers: Headers) -> ASGIApp | None:
        cookies = cookie_parser("; ".join(headers.getlist("cookie")))
        if same(cookies.get(self._access.cookie_name, ""), self._access.cookie):
            return None
        return failure(401, "not signed in; open the address that hostkit printed")

    def _no_csrf(self, scope: Scope, headers: Headers) -> ASGIApp | None:
        if scope["method"] in ("GET", "HEAD"):
            return None
        if same(headers.get(CSRF_HEADER, ""), self._access.csrf):
            return None
        return failure(403, "the X-Hostkit-Token header is missing or wrong")
