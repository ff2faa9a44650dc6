"""Whether a port may be opened and who has it, told without opening it: that resets some boards."""

import contextlib
import os
from pathlib import Path
from typing import Literal

Access = Literal["ok", "forbidden", "unknown"]

PROC = Path("/proc")
LOCKS = Path("/proc/locks")


def access_of(device: str) -> Access:
    """Tell whether this user may open a port."""
    if not device.startswith("/") or not Path(device).exists():
        return "unknown"
    return "ok" if os.access(device, os.R_OK | os.W_OK) else "forbidden"


def user_of(device: str, *, proc: Path = PROC, locks: Path = LOCKS) -> str:
    """Return the program that has a port open, as far as Linux tells; empty if none is known.

    Programs of other users are not seen unless they lock the port as hostkit does.
    """
    try:
        port = os.path.realpath(device)
        identity = Path(port).stat()
    except OSError:
        return ""
    for process in proc.glob("[0-9]*"):
        if _has_open(process, port):
            return f"{_name_of(process)} ({process.name})"
    key = f"{os.major(identity.st_dev):02x}:{os.minor(identity.st_dev):02x}:{identity.st_ino}"
    with contextlib.suppress(OSError):
        for line in locks.read_text(encoding="utf-8", errors="replace").splitlines():
            if key in line.split():
                return "another program"
    return ""


def _has_open(process: Path, port: str) -> bool:
    with contextlib.suppress(OSError):
        for number in os.scandir(process / "fd"):
            with contextlib.suppress(OSError):
                # A link of /proc need not name a path, such as "socket:[1]".
                if os.readlink(number.path) == port:  # noqa: PTH115
                    return True
    return False


def _name_of(process: Path) -> str:
    try:
        name = (process / "comm").read_text(encoding="utf-8", errors="replace")
    except OSError:
        return "a program"
    return "".join(c for c in name if c.isprintable()) or "a program"
