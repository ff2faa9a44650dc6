"""What a column of a foreign CSV file is, told from its name: role and unit."""

import re
from dataclasses import dataclass

from hostkit.importers.options import AngleUnit, ForceUnit, RateUnit, TimeUnit

QUANTITIES = {
    "a": ("a", "acc", "accel", "acceleration", "accelerometer", "ac", "accl", "accelerometers"),
    "g": (
        *("g", "gyr", "gyro", "gyroscope", "gyroscopes", "gy", "w", "omega"),
        *("angvel", "angularvelocity", "angularrate", "rotationrate"),
    ),
    "m": ("m", "mag", "magn", "magnetometer", "magnetic", "magneticfield"),
    "q": ("q", "quat", "quaternion", "orientation", "orient"),
}
"""First letter of the role, and the words for it."""
TIMES = ("t", "time", "timestamp", "ts", "timestampsample", "secondselapsed", "elapsed")
TIME_WORDS: dict[str, TimeUnit] = {
    "millis": "ms",
    "milliseconds": "ms",
    "micros": "us",
    "microseconds": "us",
    "seconds": "s",
}
AXES = {"x": "x", "y": "y", "z": "z", "w": "w", "0": "x", "1": "y", "2": "z"}
QUATERNION_INDEX = {"0": "w", "1": "x", "2": "y", "3": "z"}

TIME_UNITS: dict[str, TimeUnit] = {
    **dict.fromkeys(("s", "sec", "secs", "second", "seconds"), "s"),
    **dict.fromkeys(("ms", "msec", "millis", "milliseconds"), "ms"),
    **dict.fromkeys(("us", "usec", "micros", "microseconds"), "us"),
    **dict.fromkeys(("ns", "nsec", "nanoseconds"), "ns"),
}
RATE_UNITS: dict[str, RateUnit] = {
    **dict.fromkeys(("rads", "radpers", "radianspers", "rps", "rad", "radianss"), "rad/s"),
    **dict.fromkeys(("degs", "dps", "degpers", "degreespers", "degreess", "deg"), "deg/s"),
    **dict.fromkeys(("mrads",), "mrad/s"),
    **dict.fromkeys(("mdps", "mdegs"), "mdeg/s"),
    **dict.fromkeys(("raw", "counts", "count", "lsb"), "counts"),
}
FORCE_UNITS: dict[str, ForceUnit] = {
    **dict.fromkeys(("ms2", "ms2s", "mps2", "mss", "mpss", "ms22"), "m/s2"),
    **dict.fromkeys(("g", "gs", "gee"), "g"),
    **dict.fromkeys(("mg",), "mg"),
    **dict.fromkeys(("raw", "counts", "count", "lsb"), "counts"),
}
FIELD_UNITS = {"ut": 1.0, "t": 1e6, "gauss": 100.0, "mgauss": 0.1, "nt": 1e-3}
"""Microtesla of one unit."""
ANGLE_UNITS: dict[str, AngleUnit] = {
    **dict.fromkeys(("deg", "degree", "degrees"), "deg"),
    **dict.fromkeys(("rad", "radian", "radians"), "rad"),
}
GRAVITY_FREE = ("user", "free", "linear", "lin")


@dataclass(frozen=True, slots=True, kw_only=True)
class Meaning:
    """What a name says.

    Attributes
    ----------
    role
        One of `hostkit.importers.options.ROLES`.
    unit
        The words for the unit as they stand, letters and digits only; empty if none stands there.
    rest
        Other words: the fewer, the plainer the column.
    """

    role: str
    unit: str = ""
    rest: tuple[str, ...] = ()


def meaning(name: str) -> Meaning | None:
    """Return what a column is, None if its name does not tell."""
    plain, bracket = _split_unit(name.strip())
    words = _words(plain)
    if not words:
        return None
    for find in (_time, _single, _vector):
        found = find(words, bracket)
        if found is not None:
            return found
    return None


def _split_unit(name: str) -> tuple[str, str]:
    """Take a unit in brackets off a name; a number there is an index and stays."""
    match = re.search(r"[\[({]\s*([^\])}]*[^\s\])}])\s*[\])}]", name)
    if match is None or match.group(1).isdigit():
        return name, ""
    return name[: match.start()] + name[match.end() :], squeezed(match.group(1))


def bracketed(name: str) -> str:
    """Return the unit in brackets in a name, as letters and digits; empty if there is none."""
    return _split_unit(name)[1]


def squeezed(unit: str) -> str:
    """Return a unit as letters and digits: ``m/s^2``, ``m s-2`` and ``m/s²`` all give ``ms2``."""
    text = unit.lower().replace("²", "2").replace("µ", "u").replace("μ", "u")
    return re.sub(r"[^a-z0-9]", "", re.sub("sec(ond)?s?", "s", text.replace("°", "deg")))


def is_unit(text: str) -> bool:
    """Tell whether a cell is a unit and nothing else."""
    known = (*TIME_UNITS, *RATE_UNITS, *FORCE_UNITS, *FIELD_UNITS, *ANGLE_UNITS)
    return squeezed(text) in known


def _words(name: str) -> list[str]:
    spaced = re.sub(r"([a-z0-9])([A-Z])", r"\1 \2", name)
    return [word for word in re.split(r"[^a-z0-9²°]+", spaced.lower()) if word]


def _time(words: list[str], bracket: str) -> Meaning | None:
    joined = "".join(words)
    if joined in TIME_WORDS:
        return Meaning(role="t", unit=bracket or TIME_WORDS[joined])
    if joined in TIMES or (words[0] in TIMES and words[0] != "t"):
        unit = bracket or (words[-1] if len(words) > 1 and words[-1] in TIME_UNITS else "")
        rest = [word for word in words[1:] if word != unit]
        if joined == "secondselapsed":
            return Meaning(role="t", unit="s")
        return Meaning(role="t", unit=unit, rest=tuple(rest))
    match = re.fullmatch(r"(?:time|timestamp|t)(ms|us|ns|s)", joined)
    return Meaning(role="t", unit=match.group(1)) if match else None


def _single(words: list[str], bracket: str) -> Meaning | None:
    """Recognise temperature, roll, pitch, valid and quaternions named ``q0`` or ``qw``."""
    for role, known in (
        ("temp", ("temp", "temperature", "tmp")),
        ("roll", ("roll",)),
        ("pitch", ("pitch",)),
        ("valid", ("valid",)),
    ):
        if any(word in known for word in words) and not any(w in QUANTITIES["g"] for w in words):
            rest = [word for word in words if word not in known and word != "ref"]
            unit = bracket or "".join(word for word in rest if word in ANGLE_UNITS)
            return Meaning(role=role, unit=unit, rest=tuple(w for w in rest if w != unit))
    for place, word in enumerate(words):
        match = re.fullmatch(r"(?:q|quat)([wxyz0-3])", word)
        if match:
            axis = QUATERNION_INDEX.get(match.group(1), match.group(1))
            rest = [w for w in words[:place] + words[place + 1 :] if w != "ref"]
            return Meaning(role=f"q{axis}", rest=tuple(rest))
    return None


def _vector(words: list[str], bracket: str) -> Meaning | None:
    """Recognise one axis of rate, force, field or quaternion."""
    found = _spelled(words) or _compact(words)
    if found is None:
        return None
    letter, axis, others = found
    if letter == "q":
        return Meaning(role=f"q{axis}", rest=tuple(w for w in others if w != "ref"))
    if axis == "w":
        return None
    known = {"a": set(FORCE_UNITS), "g": set(RATE_UNITS), "m": set(FIELD_UNITS)}[letter]
    unit, rest = bracket, others
    if not unit:
        unit, rest = _trailing_unit(others, known)
    return Meaning(role=f"{letter}{axis}", unit=unit, rest=tuple(rest))


def _compact(words: list[str]) -> tuple[str, str, list[str]] | None:
    """Find ``ax``, ``gyroX``, ``xacc``, ``AcX`` written as one word or two."""
    for place, word in enumerate(words):
        for letter, names in QUANTITIES.items():
            for name in names:
                axis = word.removeprefix(name) if word.startswith(name) else ""
                if not axis and word.endswith(name) and len(name) > 2:
                    axis = word.removesuffix(name)
                if axis in ("x", "y", "z"):
                    return letter, axis, words[:place] + words[place + 1 :]
    return None


def _spelled(words: list[str]) -> tuple[str, str, list[str]] | None:
    """Find a quantity and an axis as words of their own: ``acc_x``, ``gyro [0]``."""
    axes = [word for word in words if word in AXES]
    if not axes:
        return None
    axis = axes[-1]
    others = [word for word in words if word != axis]
    joined = "".join(others)
    for letter, names in QUANTITIES.items():
        index = QUATERNION_INDEX if letter == "q" else AXES
        where = [word for word in others if word.rstrip("0123456789") in names]
        whole = [n for n in names if len(n) > 6 and joined.startswith(n)]
        if where or whole:
            rest = [word for word in others if word not in where]
            if not where:
                rest = [joined.removeprefix(whole[-1])] if joined != whole[-1] else []
            return letter, index.get(axis, axis), rest
    return None


def _trailing_unit(words: list[str], known: set[str]) -> tuple[str, list[str]]:
    """Return the unit that ends a name such as ``gyro_x_deg_s``, and the words before it."""
    for count in (3, 2, 1):
        tail = squeezed("".join(words[-count:]))
        if len(words) >= count and tail in known:
            return tail, words[:-count]
    return "", words
