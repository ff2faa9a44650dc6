"""The options of ``monitor``: where the device is, what it must keep, and where things go."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import click

from hostkit.cli.chosen import Command
from hostkit.cli.inputs import finite
from hostkit.link.frames.signing import SigningKey
from hostkit.monitor.controls import SPEEDS
from hostkit.records import FilterDesign
from hostkit.targets.atmega328p import ATMEGA328P
from hostkit.validation import DEFAULT_MAX_LOST_SHARE, DEFAULT_MAX_RMS_DEG, Thresholds

CHOSEN: Final = "hostkit.monitor"
FILE_PREFIX: Final = "file:"
BAUD_LIMITS: Final = (300, 12_000_000)
_FILE: Final = click.Path(dir_okay=False, path_type=Path)


@dataclass(frozen=True, slots=True, kw_only=True)
class MonitorChoice:
    """What was chosen on the command line.

    Attributes
    ----------
    port
        Name of a port, ``auto``, or ``file:FLIGHT.tlog``.
    baud
        Bit rate of a serial port; None finds it out.
    speed, seek_s
        How fast to replay a file, None as fast as it can be read; and from where on.
    web_port
        0 takes a free one.
    """

    port: str = "auto"
    baud: int | None = ATMEGA328P.baud
    duration_s: float | None = None
    system: int | None = None
    signing_key: Path | None = None
    passive: bool = False
    no_reconnect: bool = False
    speed: float | None = None
    seek_s: float | None = None
    max_rms_deg: float | None = None
    max_abs_deg: float | None = None
    max_lost_percent: float | None = None
    max_lag_ms: float | None = None
    max_drift_deg_min: float | None = None
    as_designed: bool = False
    in_float: bool = False
    records: tuple[Path, ...] = ()
    forwards: tuple[str, ...] = ()
    json_udp: tuple[str, ...] = ()
    report: Path | None = None
    junit: Path | None = None
    web: bool = False
    web_host: str | None = None
    web_allow_remote: bool = False
    web_allow_hosts: tuple[str, ...] = ()
    web_port: int = 0
    no_browser: bool = False

    @property
    def file(self) -> Path | None:
        """The file to be replayed; None for a live port."""
        if not self.port.startswith(FILE_PREFIX):
            return None
        return Path(self.port.removeprefix(FILE_PREFIX))

    def thresholds(self, design: FilterDesign) -> Thresholds:
        """Return the limits: those of the command line, else of the design, else the defaults."""
        percent = self.max_lost_percent
        return Thresholds.of(
            design,
            max_rms_deg=self.max_rms_deg,
            max_abs_deg=self.max_abs_deg,
            max_lost_share=None if percent is None else percent / 100.0,
            max_lag_ms=self.max_lag_ms,
            max_drift_deg_min=self.max_drift_deg_min,
        )

    def signing(self) -> SigningKey | None:
        """Read the key.

        Raises
        ------
        DeviceError
            If its file cannot be read, or others may read it, too.
        """
        return None if self.signing_key is None else SigningKey.read(self.signing_key)

    def require_consistent(self) -> None:
        """Refuse options that mean nothing together.

        Raises
        ------
        click.UsageError
            With what does not go together.
        """
        if self.file is None and (self.speed is not None or self.seek_s is not None):
            raise click.UsageError("--speed and --seek are for files; give --port file:F.tlog")
        served = self.web_host or self.web_allow_remote or self.web_allow_hosts or self.web_port
        if (served or self.no_browser) and not self.web:
            raise click.UsageError("--web-... and --no-browser need --web")


def monitor_options(command: Command) -> Command:
    """Give a command the options; see :func:`chosen_monitor`."""
    for option in reversed((*PORT_OPTIONS, *_REPLAY, *_LIMITS, *_OUTPUTS, *_WEB)):
        command = option(command)
    return command


def chosen_monitor() -> MonitorChoice:
    """Return what was chosen for the running command.

    Raises
    ------
    click.UsageError
        If options do not go together.
    """
    choice = MonitorChoice(**click.get_current_context().meta.get(CHOSEN, {}))
    choice.require_consistent()
    return choice


def _note(context: click.Context, parameter: click.Parameter, value: Any) -> None:
    if value is None or value == () or value is False:
        return
    context.meta.setdefault(CHOSEN, {})[str(parameter.name)] = value


def _note_baud(context: click.Context, parameter: click.Parameter, value: str | None) -> None:
    """Note a bit rate, or None to find it out."""
    if value is None:
        return
    low, high = BAUD_LIMITS
    if value != "auto" and not (value.isdecimal() and low <= int(value) <= high):
        raise click.BadParameter(f"{value!r} is neither auto nor a number from {low} to {high}")
    rate = None if value == "auto" else int(value)
    context.meta.setdefault(CHOSEN, {})[str(parameter.name)] = rate


def _finite_note(context: click.Context, parameter: click.Parameter, value: Any) -> None:
    _note(context, parameter, finite(context, parameter, value))


def _option(*names: str, **settings: Any) -> Any:
    callback = settings.pop("callback", _note)
    return click.option(*names, callback=callback, expose_value=False, **settings)


def _limit(name: str, help_text: str, *, most: float | None = None) -> Any:
    kind = click.FloatRange(0.0, most)
    return _option(name, type=kind, callback=_finite_note, metavar="X", help=help_text)


PORT_OPTIONS = (
    _option(
        "--port",
        metavar="P",
        help="/dev/ttyUSB0, COM3, a pty, usb:VID:PID, tcp:HOST:PORT, udp:HOST:PORT or "
        "file:FLIGHT.tlog; by default the only USB serial port there is.",
    ),
    _option(
        "--baud",
        callback=_note_baud,
        metavar="RATE",
        help=f"Bit rate of a serial port, or auto to find it out; {ATMEGA328P.baud} by default.",
    ),
    _option(
        "--duration",
        "duration_s",
        type=click.FloatRange(min=0.0, min_open=True),
        callback=_finite_note,
        metavar="S",
        help="Seconds to look at the device; without it until Ctrl-C or the end of a file.",
    ),
    _option(
        "--system",
        type=click.IntRange(1, 255),
        metavar="N",
        help="System id of the device; by default the first that sends samples.",
    ),
    _option(
        "--signing-key",
        type=click.Path(exists=True, dir_okay=False, path_type=Path),
        metavar="F",
        help="File with the secret; frames that are not signed with it are refused.",
    ),
    _option("--no-reconnect", is_flag=True, help="End when the device goes away or stays silent."),
)
"""Those that say where the device is; of every command that listens to one."""

_REPLAY = (
    _option("--passive", is_flag=True, help="Send nothing to the device."),
    _option(
        "--speed",
        type=click.FloatRange(*SPEEDS),
        callback=_finite_note,
        metavar="X",
        help="Replay a file so many times as fast as it was; by default as fast as it can be "
        "read, with --web as it was.",
    ),
    _option(
        "--seek",
        "seek_s",
        type=click.FloatRange(min=0.0),
        callback=_finite_note,
        metavar="S",
        help="Replay a file from there on.",
    ),
)
_LIMITS = (
    _limit(
        "--max-rms-deg",
        "Largest RMS residual against the float model that passes; by default the design's, else "
        f"{DEFAULT_MAX_RMS_DEG:g}.",
    ),
    _limit("--max-abs-deg", "Largest residual that passes; by default the design's, else any."),
    _limit(
        "--max-lost-percent",
        "Largest share of lost samples that passes; by default the design's, else "
        f"{100.0 * DEFAULT_MAX_LOST_SHARE:g}.",
        most=100.0,
    ),
    _limit("--max-lag-ms", "Largest lag behind the float model that passes."),
    _limit("--max-drift-deg-min", "Largest drift of the residual, deg per minute, that passes."),
    _option(
        "--as-designed",
        is_flag=True,
        help="Refuse a device that runs its design with other parameters.",
    ),
    _option("--float", "in_float", is_flag=True, help="The firmware computes in float."),
)
_OUTPUTS = (
    _option(
        "--record",
        "records",
        multiple=True,
        type=_FILE,
        metavar="F",
        help="Keep what is received: all of it in F.tlog, the samples in F.csv or F.npz; may be "
        "given again.",
    ),
    _option(
        "--forward",
        "forwards",
        multiple=True,
        metavar="udp:HOST:PORT",
        help="Pass every frame on, to QGroundControl or MAVProxy, and theirs to the device; may "
        "be given again.",
    ),
    _option(
        "--json-udp",
        multiple=True,
        metavar="HOST:PORT",
        help="Send every sample as JSON, as PlotJuggler reads it; may be given again.",
    ),
    _option("--report", type=_FILE, metavar="F.html", help="Write a report."),
    _option("--junit", type=_FILE, metavar="F.xml", help="Write the verdict for a build server."),
)
_WEB = (
    _option("--web", is_flag=True, help="Show a page in the browser."),
    _option(
        "--web-host",
        metavar="HOST",
        help="Address to serve the page at; 127.0.0.1 by default.",
    ),
    _option(
        "--web-allow-remote",
        is_flag=True,
        help="Serve at an address that other machines reach; there is no encryption.",
    ),
    _option(
        "--web-allow-host",
        "web_allow_hosts",
        multiple=True,
        metavar="NAME",
        help="A further name of this machine that browsers may use; may be given again.",
    ),
    _option(
        "--web-port",
        type=click.IntRange(0, 65535),
        metavar="N",
        help="Port to serve the page at; by default a free one.",
    ),
    _option("--no-browser", is_flag=True, help="Do not open a browser."),
)
