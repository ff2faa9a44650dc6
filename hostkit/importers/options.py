"""What the user may say of a file that is imported, beyond what the file says itself."""

from dataclasses import dataclass, fields
from pathlib import Path
from typing import Final, Literal

from hostkit.errors import RecordingError

TimeUnit = Literal["s", "ms", "us", "ns"]
RateUnit = Literal["rad/s", "deg/s", "mrad/s", "mdeg/s", "counts"]
ForceUnit = Literal["m/s2", "g", "mg", "counts"]
AngleUnit = Literal["rad", "deg"]

TIME_UNITS: Final[tuple[TimeUnit, ...]] = ("s", "ms", "us", "ns")
RATE_UNITS: Final[tuple[RateUnit, ...]] = ("rad/s", "deg/s", "mrad/s", "mdeg/s", "counts")
FORCE_UNITS: Final[tuple[ForceUnit, ...]] = ("m/s2", "g", "mg", "counts")
ANGLE_UNITS: Final[tuple[AngleUnit, ...]] = ("rad", "deg")

ROLES: Final = (
    *("t", "ax", "ay", "az", "gx", "gy", "gz", "mx", "my", "mz"),
    *("temp", "roll", "pitch", "qw", "qx", "qy", "qz", "valid"),
)
"""What a column can be: time, force, rate, field, temperature, reference, valid."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ColumnChoice:
    """One column as the user names it.

    Attributes
    ----------
    role
        What it is, one of `ROLES`.
    column
        Its name in the header, or its number from 1.
    negated
        Whether its values change their sign.
    """

    role: str
    column: str
    negated: bool = False

    def __post_init__(self) -> None:
        """Refuse a role that does not exist."""
        if self.role not in ROLES:
            raise RecordingError(
                f"{self.role!r} is no role of a column; the roles are: {', '.join(ROLES)}"
            )


def parse_columns(text: str) -> tuple[ColumnChoice, ...]:
    """Read ``t=1,ax=accX,gy=-gyroY``: roles with the name or number of a column.

    Raises
    ------
    RecordingError
        If a part is not ``role=column``, or a role is unknown or named twice.
    """
    choices = []
    for part in text.split(","):
        role, equals, column = (piece.strip() for piece in part.partition("="))
        if not equals or not column.lstrip("-"):
            raise RecordingError(
                f"{part!r} is not ROLE=COLUMN, such as t=1, ax=accX or gy=-gyroY (sign turned)"
            )
        negated = column.startswith("-")
        choices.append(ColumnChoice(role=role, column=column.removeprefix("-"), negated=negated))
    roles = [choice.role for choice in choices]
    doubled = sorted({role for role in roles if roles.count(role) > 1})
    if doubled:
        raise RecordingError(f"--columns names {', '.join(doubled)} twice")
    return tuple(choices)


@dataclass(frozen=True, slots=True, kw_only=True)
class ImportOptions:
    """What the user said; None and empty stand for "not said".

    Attributes
    ----------
    columns
        Which column is what (csv).
    time_unit, gyro_unit, accel_unit, angle_unit
        Units of a file that states none, or states them wrongly.
    gyro_range, accel_range
        Full scale of counts, deg/s and g.
    rate_hz
        Nominal sample rate; needed where the file has no time.
    message, system, instance, topic
        Which stream of a file that holds several.
    design
        Design file that says in which ranges a device of hostkit measured (tlog).
    reference
        Whether the attitude in the file is taken as the reference.
    resample_hz
        Rate of a uniform grid to bring the samples to.
    decimate
        How many samples become one.
    """

    columns: tuple[ColumnChoice, ...] = ()
    time_unit: TimeUnit | None = None
    gyro_unit: RateUnit | None = None
    accel_unit: ForceUnit | None = None
    angle_unit: AngleUnit | None = None
    gyro_range: float | None = None
    accel_range: float | None = None
    rate_hz: float | None = None
    message: str | None = None
    system: int | None = None
    instance: int | None = None
    topic: str | None = None
    design: Path | None = None
    reference: bool = True
    resample_hz: float | None = None
    decimate: int = 1

    def said(self) -> frozenset[str]:
        """Return the names of the fields that differ from "not said"."""
        return frozenset(f.name for f in fields(self) if getattr(self, f.name) != f.default)


COMMON_OPTIONS: Final = frozenset({"reference", "resample_hz", "decimate"})
"""Options that every format takes."""
