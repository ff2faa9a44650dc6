"""The MAVLink dialect of hostkit, made by the installed pymavlink for C and for Python.

The standard messages are taken out of the definitions that pymavlink ships; only ``TILT_SAMPLE``
and ``TILT_STATE`` are written here. Nothing that mavgen makes is committed: headers are made when
code is generated, the Python module when it is first needed.
"""

import contextlib
import importlib.util
import io
import re
import sys
import tempfile
from functools import lru_cache
from importlib.metadata import version
from pathlib import Path
from types import ModuleType
from xml.etree import ElementTree

from hostkit.errors import RenderError
from hostkit.records import GeneratedFile

STANDARD_MESSAGES = (
    *("HEARTBEAT", "SYS_STATUS", "STATUSTEXT"),
    *("ATTITUDE", "SCALED_IMU", "RAW_IMU", "HIGHRES_IMU"),
    *("PARAM_REQUEST_LIST", "PARAM_REQUEST_READ", "PARAM_SET", "PARAM_VALUE"),
    *("COMMAND_LONG", "COMMAND_ACK", "AUTOPILOT_VERSION", "TIMESYNC", "PING"),
    "SETUP_SIGNING",
)
COMMANDS = (
    "MAV_CMD_PREFLIGHT_CALIBRATION",
    "MAV_CMD_PREFLIGHT_STORAGE",
    "MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN",
    "MAV_CMD_SET_MESSAGE_INTERVAL",
    "MAV_CMD_REQUEST_MESSAGE",
    "MAV_CMD_USER_1",
)
"""The commands of MAV_CMD that the firmware knows; the others are left out."""
STANDARD_DEFINITIONS = ("minimal.xml", "standard.xml", "common.xml")
HEADER_FOLDER = "mavlink"
DIALECT = "hostkit"
FRAME_OVERHEAD_BYTES = 12
"""Header and checksum of an unsigned MAVLink 2 frame."""
SIGNATURE_BYTES = 13
"""What a signature adds to a frame."""
HIDDEN_WORDS = 2
"""Words that ``TILT_SAMPLE`` has for the state of a filter beside its angles."""
STATE_WORDS = 24
"""Words that ``TILT_STATE`` has for a state of which ``TILT_SAMPLE`` tells nothing."""
HIDDEN_WORD_BYTES = 4


def definition() -> str:
    """Return the dialect as one self-contained XML text.

    Raises
    ------
    RenderError
        If the installed pymavlink does not define a message that hostkit sends.
    """
    import pymavlink

    folder = Path(pymavlink.__file__).parent / "dialects" / "v20"
    sources = [ElementTree.parse(folder / name).getroot() for name in STANDARD_DEFINITIONS]
    own = ElementTree.parse(Path(__file__).with_name("hostkit_messages.xml")).getroot()
    messages = [_find_message(sources, name) for name in STANDARD_MESSAGES]
    wanted = {field.get("enum") for m in messages for field in m.iter("field")} - {None}
    found: dict[str | None, ElementTree.Element] = {}
    for source in sources:
        for enum in source.iter("enum"):
            if enum.get("name") in wanted:
                _join(
                    found.setdefault(enum.get("name"), ElementTree.Element("enum", enum.attrib)),
                    enum,
                )
    root = ElementTree.Element("mavlink")
    enums = ElementTree.SubElement(root, "enums")
    enums.extend([*found.values(), *own.iter("enum")])
    ElementTree.SubElement(root, "messages").extend([*messages, *own.iter("message")])
    return ElementTree.tostring(root, encoding="unicode")


def _join(enum: ElementTree.Element, part: ElementTree.Element) -> None:
    """Add the entries of a part of an enum; of the many commands only those that are known."""
    commands = enum.get("name") == "MAV_CMD"
    enum.extend(e for e in part.iter("entry") if not commands or e.get("name") in COMMANDS)


def _find_message(sources: list[ElementTree.Element], name: str) -> ElementTree.Element:
    for source in sources:
        for message in source.iter("message"):
            if message.get("name") == name:
                return message
    raise RenderError(
        f"pymavlink {version('pymavlink')} defines no message {name}; "
        "install pymavlink 2.4.41 or later"
    )


def _mavgen(language: str, output: Path, folder: Path) -> None:
    """Run mavgen, silently, and make sure that it produced something."""
    from pymavlink.generator import mavgen, mavparse

    source = folder / f"{DIALECT}.xml"
    source.write_text(definition(), encoding="utf-8")
    options = mavgen.Opts(str(output), wire_protocol=mavparse.PROTOCOL_2_0, language=language)
    options.validate = False
    said = io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        mavgen.mavgen(options, [str(source)])
    if not output.exists():
        raise RenderError(f"mavgen made nothing for {language}; it said: {said.getvalue()[-300:]}")


@lru_cache(maxsize=1)
def c_headers() -> tuple[GeneratedFile, ...]:
    """Return the C headers of the dialect, under ``mavlink/``; the build date is taken out."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        output = folder / HEADER_FOLDER
        _mavgen("C", output, folder)
        files = [
            GeneratedFile(
                path=path.relative_to(folder).as_posix(),
                content=_without_date(path.read_text(encoding="utf-8")),
            )
            for path in sorted(output.rglob("*.h"))
            if path.name != "testsuite.h"
        ]
    return tuple(sorted(files, key=lambda file: file.path))


def _without_date(text: str) -> str:
    text = re.sub(r'(#define MAVLINK_BUILD_DATE) ".*"', r'\1 ""', text)
    return re.sub(r"\r\n?", "\n", text)


@lru_cache(maxsize=1)
def python_module() -> ModuleType:
    """Return the Python module of the dialect; making it takes about 0.1 s.

    Raises
    ------
    RenderError
        If mavgen makes nothing.
    """
    name = f"{DIALECT}_dialect"
    with tempfile.TemporaryDirectory() as folder:
        output = Path(folder) / f"{name}.py"
        _mavgen("Python3", output, Path(folder))
        spec = importlib.util.spec_from_file_location(name, output)
        assert spec is not None
        assert spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        sys.modules[name] = module
        spec.loader.exec_module(module)
    return module


def payload_bytes(message: str) -> int:
    """Return the size of a message's payload before trailing zeros are cut."""
    module = python_module()
    message_id = getattr(module, f"MAVLINK_MSG_ID_{message}")
    return int(module.mavlink_map[message_id].unpacker.size)


def sample_bytes(hidden_words: int) -> int:
    """Return the size of ``TILT_SAMPLE``'s payload when so many of its hidden words are used.

    They are its last fields, and MAVLink 2 cuts trailing zeros.
    """
    return payload_bytes("TILT_SAMPLE") - HIDDEN_WORD_BYTES * (HIDDEN_WORDS - hidden_words)


def state_bytes(words: int) -> int:
    """Return the size of ``TILT_STATE``'s payload when so many of its words are used."""
    return payload_bytes("TILT_STATE") - HIDDEN_WORD_BYTES * (STATE_WORDS - words)
