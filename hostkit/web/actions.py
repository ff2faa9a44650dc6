"""What a page may ask of a session: each request checked, then passed on."""

import json
import re
from collections.abc import Callable
from pathlib import Path

from hostkit.errors import HostkitError
from hostkit.monitor.snapshot import Controls
from hostkit.web.files import RECORDING_SUFFIXES, is_recording_name, new_recording

BODY_BYTES = 4096
COMMANDS = ("calibrate", "self-test", "store", "defaults", "reboot")
PARAMETER_NAME = re.compile(r"[A-Za-z0-9_]{1,16}")
LARGEST = 3.4028234e38
"""A parameter travels as a 32-bit float."""

Body = dict[str, object]


class BadRequestError(HostkitError):
    """A request that no session could make sense of."""


def parse(body: bytes) -> Body:
    """Return the flat JSON object of a request.

    Raises
    ------
    BadRequestError
        If it is anything else.
    """
    try:
        value = json.loads(
            body.decode("utf-8"), parse_constant=_no_number, object_pairs_hook=_object
        )
    except (ValueError, RecursionError) as error:
        raise BadRequestError("the body is not a JSON object of single values") from error
    if not isinstance(value, dict):
        raise BadRequestError("the body is not a JSON object of single values")
    return value


def _no_number(text: str) -> object:
    raise ValueError(f"{text} is not JSON")


def _object(pairs: list[tuple[str, object]]) -> Body:
    if len({key for key, _ in pairs}) != len(pairs):
        raise ValueError("a key appears twice")
    if any(isinstance(value, dict | list) for _, value in pairs):
        raise ValueError("values may not be nested")
    return dict(pairs)


def _keys(body: Body, needed: tuple[str, ...], allowed: tuple[str, ...] = ()) -> None:
    missing = [key for key in needed if key not in body]
    unknown = sorted(set(body) - set(needed) - set(allowed))
    if missing:
        raise BadRequestError(f"{missing[0]!r} is missing")
    if unknown:
        raise BadRequestError(f"{unknown[0]!r:.40} is not known here; known: {needed + allowed}")


def _choice(body: Body, key: str, choices: tuple[str, ...]) -> str:
    value = body[key]
    if isinstance(value, str) and value in choices:
        return value
    raise BadRequestError(f"{key} is not one of {', '.join(choices)}")


def _number(body: Body, key: str, lowest: float, highest: float) -> float:
    value = body.get(key)
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise BadRequestError(f"{key} is not a number")
    # Compared before it is converted: an integer may be too large for a float.
    if not lowest <= value <= highest:
        raise BadRequestError(f"{key} is outside [{lowest:g}, {highest:g}]")
    return float(value)


class Actions:
    """The requests that change something, by their path under ``/api/``."""

    def __init__(self, controls: Controls, folder: Path) -> None:
        self._controls = controls
        self._folder = folder
        self.by_path: dict[str, Callable[[Body], None]] = {
            "parameters": self._set_parameter,
            "parameters/revert": self._revert,
            "command": self._command,
            "recording": self._recording,
            "port": self._port,
            "verdict": self._verdict,
            "replay": self._replay,
        }

    def _set_parameter(self, body: Body) -> None:
        _keys(body, ("name", "value"))
        name = body["name"]
        if not isinstance(name, str) or not PARAMETER_NAME.fullmatch(name):
            raise BadRequestError("name is not 1 to 16 letters, digits and underscores")
        self._controls.set_parameter(name, _number(body, "value", -LARGEST, LARGEST))

    def _revert(self, body: Body) -> None:
        _keys(body, ())
        self._controls.revert_parameters()

    def _command(self, body: Body) -> None:
        _keys(body, ("name",))
        self._controls.command(_choice(body, "name", COMMANDS))

    def _recording(self, body: Body) -> None:
        _keys(body, ("action",), ("name",))
        if _choice(body, "action", ("start", "stop")) == "stop":
            self._controls.stop_recording()
            return
        name = body.get("name")
        if not isinstance(name, str) or not is_recording_name(name):
            raise BadRequestError(
                "name is not 1 to 80 of A-Z a-z 0-9 . _ -, not beginning with a dot, ending in "
                + ", ".join(RECORDING_SUFFIXES)
            )
        self._controls.start_recording(new_recording(self._folder, name))

    def _port(self, body: Body) -> None:
        _keys(body, ("action",))
        if _choice(body, "action", ("release", "take")) == "release":
            self._controls.release_port()
        else:
            self._controls.take_port()

    def _verdict(self, body: Body) -> None:
        _keys(body, ("action",))
        _choice(body, "action", ("restart",))
        self._controls.restart_verdict()

    def _replay(self, body: Body) -> None:
        _keys(body, ("action",), ("value",))
        action = _choice(body, "action", ("pause", "resume", "seek", "speed"))
        if action == "seek":
            self._controls.seek(_number(body, "value", 0.0, 1e9))
        elif action == "speed":
            as_fast = "value" in body and body["value"] is None
            self._controls.set_speed(None if as_fast else _number(body, "value", 0.01, 1000.0))
        else:
            self._controls.pause(action == "pause")
