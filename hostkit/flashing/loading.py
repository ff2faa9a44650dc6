"""Choosing a programmer, and running it."""

import os
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

from hostkit.emulation.run import build
from hostkit.errors import BuildError, DeviceError, HostkitError, ToolMissingError
from hostkit.flashing.drive import MARK, find_drives, is_drive
from hostkit.flashing.programmer import PROGRAMMERS, Programmer
from hostkit.targets import Target

BOOT_BAUD = 115200
"""Of the Arduino Uno's boot loader and the newer Nano's; an old Nano has 57600."""
TIMEOUT_S = 300.0
STANDARD_ERROR = 2


@dataclass(frozen=True, slots=True, kw_only=True)
class FlashPlan:
    """What will be run, in which folder."""

    programmer: Programmer
    folder: Path
    port: str | None
    command: tuple[str, ...]


def plan_flash(
    folder: Path,
    target: Target,
    *,
    port: str | None = None,
    programmer: str | None = None,
    boot_baud: int = BOOT_BAUD,
) -> FlashPlan:
    """Choose how to load a generated folder into its board.

    Parameters
    ----------
    port
        Serial port, or the drive of a Pico, where the programmer needs one.
    programmer
        Its name; None takes the first that is installed.
    boot_baud
        Rate of an AVR's boot loader, bit/s.

    Raises
    ------
    DeviceError
        If a port or drive is missing or not there, or may not be used.
    HostkitError
        If the target is not flashed, or the programmer is none of its own or takes no port.
    ToolMissingError
        If what is needed is not installed.
    """
    ways = tuple(way for way in PROGRAMMERS if way.target == target.name)
    if not ways:
        flashed = ", ".join(dict.fromkeys(way.target for way in PROGRAMMERS))
        raise HostkitError(f"{target.name} is not flashed; there are programmers for: {flashed}")
    way = _named(ways, programmer) if programmer else _first(ways, port)
    if not way.installed:
        raise ToolMissingError(f"{way.program} is not installed: {way.hint}")
    port = _checked_port(way, port)
    words = tuple(word.replace("{boot_baud}", str(boot_baud)) for word in way.command_for(port))
    return FlashPlan(programmer=way, folder=folder, port=port, command=words)


def _named(ways: tuple[Programmer, ...], name: str) -> Programmer:
    for way in ways:
        if way.name == name:
            return way
    raise HostkitError(
        f"{name} does not load the {ways[0].target}; what does: "
        + ", ".join(way.name for way in ways)
    )


def _first(ways: tuple[Programmer, ...], port: str | None) -> Programmer:
    """Return the first way that works here; copying needs a drive."""
    for way in ways:
        if way.by_name_only:
            continue
        if way.port_use == "drive" and not (find_drives() or (port and Path(port).is_dir())):
            continue
        if way.installed and not (port and way.port_use == "none"):
            return way
    wanted = "; ".join(f"{way.name}: {way.hint}" for way in ways if not way.by_name_only)
    with_port = " that takes a --port" if port else ""
    raise ToolMissingError(f"nothing{with_port} is here to load the {ways[0].target}: {wanted}")


def _checked_port(way: Programmer, port: str | None) -> str | None:
    if way.port_use == "none":
        if port is not None:
            raise HostkitError(f"{way.name} finds the board by itself and takes no --port")
        return None
    if way.port_use == "drive":
        return str(_drive(port))
    if port is None:
        if way.port_use == "serial":
            raise DeviceError(f"{way.name} needs --port; {_ports_here()}")
        return None
    if port.startswith("/"):
        _require_usable(port)
    return port


def _require_usable(port: str) -> None:
    if not Path(port).exists():
        raise DeviceError(f"{port} does not exist; {_ports_here()}")
    if not os.access(port, os.R_OK | os.W_OK):
        raise DeviceError(f"{port} may not be opened; on Linux join its group, often dialout")


def _ports_here() -> str:
    from serial.tools.list_ports import comports

    names = sorted(found.device for found in comports())
    return f"serial ports here: {', '.join(names)}" if names else "no serial port is here"


def _drive(port: str | None) -> Path:
    if port is not None:
        if not is_drive(Path(port)):
            raise DeviceError(f"{port} is no drive of a boot loader: it has no {MARK}")
        return Path(port)
    drives = find_drives()
    if len(drives) != 1:
        names = ", ".join(map(str, drives))
        found = f"several are: {names}; name one with --port" if drives else "none is"
        raise DeviceError(
            f"one drive of a boot loader must be mounted, and {found}; hold BOOTSEL while "
            "plugging the Pico in"
        )
    return drives[0]


def flash(plan: FlashPlan, target: Target, *, build_first: bool = True) -> None:
    """Build what is not up to date, and load it.

    What the programmer prints goes to standard error.

    Raises
    ------
    BuildError
        If the code does not compile, or there is no image.
    DeviceError
        If the programmer fails, naming its exit code, or does not end, or the drive is full.
    ToolMissingError
        If the compiler is not installed.
    """
    way = plan.programmer
    if way.image:
        if build_first:
            build(plan.folder, target)
        if not (plan.folder / way.image).is_file():
            raise BuildError(f"{plan.folder / way.image} does not exist: build it first")
    if way.port_use == "drive":
        _copy(plan)
    else:
        _run(plan)


def _copy(plan: FlashPlan) -> None:
    assert plan.port is not None
    try:
        shutil.copy(plan.folder / plan.programmer.image, plan.port)
    except OSError as error:
        raise DeviceError(f"{plan.port} did not take the image: {error.strerror}") from error


def _run(plan: FlashPlan) -> None:
    program = plan.command[0]
    try:
        done = subprocess.run(
            plan.command, cwd=plan.folder, stdout=STANDARD_ERROR, timeout=TIMEOUT_S, check=False
        )
    except OSError as error:
        raise ToolMissingError(f"{program} cannot be started: {error.strerror}") from error
    except subprocess.TimeoutExpired as error:
        raise DeviceError(f"{program} did not end within {TIMEOUT_S:g} s") from error
    if done.returncode != 0:
        raise DeviceError(
            f"{program} failed with exit code {done.returncode}; see above for what it said"
        )
