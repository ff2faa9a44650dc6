"""Answers in one form: JSON, an error, a download."""

from starlette.responses import Response

from hostkit.web.wire import encode


def answer(value: object, status: int = 200) -> Response:
    """Return a value as JSON."""
    return Response(encode(value), status_code=status, media_type="application/json")


def failure(status: int, text: str) -> Response:
    """Return why a request was refused."""
    response = answer({"error": text}, status)
    # What is left of the request's body is not worth reading.
    response.headers["Connection"] = "close"
    return response


def redirect(path: str, cookie: str) -> Response:
    """Lead to another path of this server, with a cookie for it."""
    return Response(status_code=303, headers={"Location": path, "Set-Cookie": cookie})


def download(content: bytes, name: str, media_type: str) -> Response:
    """Return a file to be kept, not shown."""
    return Response(content, media_type=media_type, headers=attachment(name))


def attachment(name: str) -> dict[str, str]:
    """Return the header that makes a browser keep a file; `name` is one checked component."""
    return {"Content-Disposition": f'attachment; filename="{name}"'}
