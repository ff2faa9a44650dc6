"""What to say when a recording lacks a column: what was found, and what looks like it."""

import re
from collections.abc import Collection, Iterable
from difflib import get_close_matches

from hostkit.errors import RecordingError

MAX_NAMES_SHOWN = 20

_LOOKALIKES = (
    (r"gyr.*(deg|dps)|^ang.*(deg|dps)", "is in deg/s: multiply by pi/180 (0.01745329)"),
    (r"gyr.*(raw|count|lsb)", "is in counts: multiply by the weight of a count in rad/s"),
    (r"acc.*(raw|count|lsb)", "is in counts: multiply by the weight of a count in m/s^2"),
    (r"acc.*(_mg|\bmg)", "is in mg: multiply by 0.00980665"),
    (r"acc.*(_g\d?|_g_[xyz]|\(g\))$", "is in g: multiply by 9.80665"),
    (r"^(t|time|timestamp)_?ms$", "is in ms: divide by 1000"),
    (r"^(t|time|timestamp)_?us$", "is in us: divide by 1e6"),
    (r"^(t|time|timestamp|seconds)$", "states no unit: bring it to s"),
)


def require_names(found: Collection[str], required: Iterable[str], kind: str) -> None:
    """Refuse a file that lacks what every recording has.

    Parameters
    ----------
    found
        Names in the file.
    required
        Names that must be there.
    kind
        What a name is in this format: ``column`` or ``array``.

    Raises
    ------
    RecordingError
        If one is missing; the message lists the missing ones, the found ones, and what to do with
        those that look like a missing one in another unit.
    """
    missing = [name for name in required if name not in found]
    if not missing:
        return
    parts = [f"it lacks the {kind}(s) {', '.join(missing)}", f"it has {_listed(found)}"]
    parts += _hints(missing, [name for name in found if name not in required])
    raise RecordingError("; ".join(parts))


def time_name(found: Collection[str], kind: str) -> str:
    """Return the name of the time, ``time_us`` if that is there and ``time_s`` if not.

    Raises
    ------
    RecordingError
        If both are there.
    """
    if "time_s" in found and "time_us" in found:
        raise RecordingError(f"it has the {kind}s time_s and time_us; keep one of them")
    return "time_us" if "time_us" in found else "time_s"


def require_whole(found: Collection[str], group: tuple[str, ...], kind: str) -> bool:
    """Return whether an optional group is there, and refuse a part of one.

    Raises
    ------
    RecordingError
        If some of the group are there and some are not.
    """
    if not any(name in found for name in group):
        return False
    require_names(found, group, kind)
    return True


def _listed(found: Collection[str]) -> str:
    names = [name[:40] for name in found][:MAX_NAMES_SHOWN]
    more = len(found) - len(names)
    return (", ".join(names) or "nothing") + (f" and {more} more" if more else "")


def _hints(missing: list[str], others: list[str]) -> list[str]:
    pairs = [(name, _likeness(name, missing), _action(name)) for name in others]
    sure = [(name, like, action) for name, like, action in pairs if like and action]
    settled = {like for _, like, _ in sure}
    hints = [f"{name} {action} and call it {like}" for name, like, action in sure]
    hints += [
        f"is {name} meant to be {like}?" for name, like, _ in pairs if like and like not in settled
    ]
    return hints[:MAX_NAMES_SHOWN]


def _action(name: str) -> str:
    return next((act for pattern, act in _LOOKALIKES if re.search(pattern, name.lower())), "")


def _likeness(name: str, missing: list[str]) -> str:
    """Return the missing name that `name` may stand for, or nothing."""
    near = get_close_matches(name.lower(), missing, n=1, cutoff=0.75)
    if near:
        return near[0]
    lower = name.lower()
    kin = [m for m in missing if m[:3] == lower[:3] or (m[0] == "t" and re.match(r"t_|t$", lower))]
    axis = re.search(r"(?:^|_|[a-z])([xyz])(?:_|$)", lower)
    if axis and len(kin) > 1:
        kin = [m for m in kin if f"_{axis.group(1)}_" in m]
    return kin[0] if kin else ""
