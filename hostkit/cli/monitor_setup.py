"""From the options of a session to its parts: port, recorders, outlets, page."""

import contextlib
import os
import sys
import webbrowser
from collections.abc import Sequence
from pathlib import Path

from hostkit.cli.inputs import say
from hostkit.cli.monitor_options import MonitorChoice
from hostkit.cli.output import json_text
from hostkit.errors import ToolMissingError
from hostkit.link.forward import Forwarder
from hostkit.link.json_udp import JsonUdp
from hostkit.link.logs.part_file import PartFile
from hostkit.link.logs.replay import ReplayTransport
from hostkit.link.ports.transport import Transport, open_link
from hostkit.monitor import Session
from hostkit.monitor.document import monitor_document
from hostkit.monitor.outlets import Outlets
from hostkit.monitor.recording.recordings import Recorder
from hostkit.monitor.recording.sample_files import open_recorder
from hostkit.records import AXES, FilterDesign


def open_port(choice: MonitorChoice) -> Transport:
    """Open the port, or the file to be replayed.

    Raises
    ------
    DeviceError
        If it cannot be opened.
    """
    if choice.file is None:
        return open_link(choice.port, choice.baud, reconnect=not choice.no_reconnect)
    speed = 1.0 if choice.speed is None and choice.web else choice.speed
    replay = ReplayTransport(choice.file, speed)
    if choice.seek_s is not None:
        replay.seek(choice.seek_s)
    return replay


def open_recorders(
    paths: Sequence[Path],
    design: FilterDesign | None,
    system: int | None,
    stack: contextlib.ExitStack,
) -> tuple[Recorder, ...]:
    """Open the files, to be closed with the stack; say what was left of earlier ones.

    Raises
    ------
    HostkitError
        If one cannot be written.
    """
    opened = []
    for path in paths:
        recorder = open_recorder(path, design, system=system)
        stack.callback(recorder.close)
        opened.append(recorder)
        left = recorder.left
        if left is not None:
            say(
                f"{PartFile.name_of_part(path)} was left of a recording that was not finished; it "
                f"is now {left}, which can be read"
            )
    return tuple(opened)


def open_outlets(
    choice: MonitorChoice, design: FilterDesign, stack: contextlib.ExitStack
) -> Outlets:
    """Open the sockets to other programs, to be closed with the stack.

    Raises
    ------
    DeviceError
        If an address is none.
    """
    outlets = Outlets(
        forwarders=[Forwarder(address) for address in choice.forwards],
        plotters=[JsonUdp(_udp(address), AXES[design.axes]) for address in choice.json_udp],
    )
    stack.callback(outlets.close)
    return outlets


def _udp(address: str) -> str:
    return address if address.startswith("udp:") else f"udp:{address}"


class SessionReports:
    """The reports of a session so far, for the page's download buttons."""

    def __init__(self, session: Session) -> None:
        self._session = session

    def html(self) -> bytes:
        """Return one self-contained page."""
        from hostkit.report.monitor import monitor_page

        return monitor_page(self._session.ask_result()).encode()

    def json(self) -> bytes:
        """Return the document of ``hostkit monitor --json``."""
        return json_text(monitor_document(self._session.ask_result())).encode()

    def xml(self) -> bytes:
        """Return a JUnit file."""
        from hostkit.report.junit import junit_xml

        return junit_xml(self._session.ask_result()).encode()


def serve_page(session: Session, choice: MonitorChoice, stack: contextlib.ExitStack) -> None:
    """Serve the page until the stack ends; show its address, and open a browser if there is one.

    Raises
    ------
    ToolMissingError
        If the server's libraries are not installed.
    HostkitError
        If the address cannot be listened on.
    """
    try:
        from hostkit.web.server import Server
    except ImportError as error:
        raise ToolMissingError(f"--web needs {error.name}: pip install 'hostkit[web]'") from error
    server = Server(
        session.controls,
        reports=SessionReports(session),
        folder=session.options.folder,
        host=choice.web_host or "127.0.0.1",
        port=choice.web_port,
        allow_remote=choice.web_allow_remote,
        allowed_hosts=choice.web_allow_hosts,
    )
    if server.warning:
        say(f"hostkit: {server.warning}")
    url = server.start()
    stack.callback(server.stop)
    session.views.append(server)
    say(f"hostkit: {url}")
    if not choice.no_browser and _has_browser():
        webbrowser.open(url)


def _has_browser() -> bool:
    """Tell whether a browser that is opened can be seen."""
    if sys.platform in ("darwin", "win32"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
