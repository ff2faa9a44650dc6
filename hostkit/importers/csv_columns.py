"""Which column of a CSV file is what: named by the user, by the header, or by the numbers."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np

from hostkit.errors import RecordingError
from hostkit.importers.csv_names import GRAVITY_FREE, Meaning, bracketed, meaning
from hostkit.importers.csv_text import TextTable
from hostkit.importers.log import Vector
from hostkit.importers.options import ColumnChoice

NEEDED = ("ax", "ay", "az", "gx", "gy", "gz")
GROUPS = (("mx", "my", "mz"), ("qw", "qx", "qy", "qz"), ("roll", "pitch"))
"""Optional roles that come together or not at all."""
MAX_SHOWN = 20
STEADIER = 3.0
"""The force's magnitude must spread by this factor less than the rate's."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Column:
    """One column that is read.

    Attributes
    ----------
    role
        What it is.
    place
        Which column, counted from 0.
    name
        Its name for messages.
    unit
        The unit that its name states, as it stands; empty if none.
    negated
        Whether its values change their sign.
    """

    role: str
    place: int
    name: str
    unit: str = ""
    negated: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Assignment:
    """The columns that are read, and what was concluded to find them."""

    columns: tuple[Column, ...]
    guessed: tuple[str, ...] = ()

    def column(self, role: str) -> Column | None:
        """Return the column of a role, None if there is none."""
        return next((column for column in self.columns if column.role == role), None)

    def unit(self, roles: Sequence[str]) -> str:
        """Return the unit that the names of some columns state, empty if none.

        Raises
        ------
        RecordingError
            If they state several.
        """
        units = sorted({c.unit for c in self.columns if c.role in roles and c.unit})
        if len(units) > 1:
            raise RecordingError(
                f"the columns {', '.join(c.name for c in self.columns if c.role in roles)} are in "
                f"different units: {', '.join(units)}"
            )
        return units[0] if units else ""


def assign(table: TextTable, chosen: Sequence[ColumnChoice], values: Vector | None) -> Assignment:
    """Say which column is what.

    Parameters
    ----------
    table
        The table, with or without a header.
    chosen
        What the user said; it goes before everything else.
    values
        The numbers of a table without a header, shape ``(N, width)``; not used where there is one.

    Raises
    ------
    RecordingError
        If a needed column is missing, ambiguous, or cannot be told from the numbers.
    """
    named = [_chosen(table, choice) for choice in chosen]
    taken = {column.place for column in named}
    roles = {column.role for column in named}
    guessed: tuple[str, ...] = ()
    if table.names:
        found = _by_name(table.names, roles)
    elif set(NEEDED) <= roles:
        found = []
    else:
        found, guessed = _by_numbers(values, taken)
    rest = [c for c in found if c.role not in roles and c.place not in taken]
    columns = _whole_groups([*named, *rest])
    _require_needed(columns, table)
    return Assignment(columns=tuple(columns), guessed=guessed)


def _chosen(table: TextTable, choice: ColumnChoice) -> Column:
    if choice.column in table.names:
        place = table.names.index(choice.column)
    elif choice.column.isdigit() and 1 <= int(choice.column) <= table.width:
        place = int(choice.column) - 1
    else:
        raise RecordingError(
            f"--columns {choice.role}={choice.column}: there is no such column; "
            f"{_listed(table)}, and they are numbered 1 to {table.width}"
        )
    name = table.names[place] if table.names else f"column {place + 1}"
    said = meaning(name) if table.names else None
    alike = said is not None and said.role[:1] == choice.role[:1]
    unit = said.unit if said is not None and alike else bracketed(name)
    return Column(role=choice.role, place=place, name=name, unit=unit, negated=choice.negated)


def _by_name(names: Sequence[str], settled: Collection[str]) -> list[Column]:
    """Return the plainest column of each role that is not settled yet."""
    meanings = [(place, name, meaning(name)) for place, name in enumerate(names)]
    known = [(p, name, m) for p, name, m in meanings if m is not None and m.role not in settled]
    return [_plainest(role, known) for role in dict.fromkeys(m.role for _, _, m in known)]


def _plainest(role: str, known: Sequence[tuple[int, str, Meaning]]) -> Column:
    def strangeness(found: tuple[int, str, Meaning]) -> tuple[bool, int, bool]:
        rest = found[2].rest
        unclear = role == "t" and not found[2].unit
        return any(word in GRAVITY_FREE for word in rest), len(rest), unclear

    ranked = sorted((k for k in known if k[2].role == role), key=strangeness)
    best = [k for k in ranked if strangeness(k) == strangeness(ranked[0])]
    if len(best) > 1 and role in (*NEEDED, "t"):
        names = ", ".join(name for _, name, _ in best[:MAX_SHOWN])
        raise RecordingError(
            f"{len(best)} columns may be {role}: {names}; say which: --columns {role}=NAME"
        )
    place, name, said = best[0]
    return Column(role=role, place=place, name=name, unit=said.unit)


def _whole_groups(columns: list[Column]) -> list[Column]:
    """Leave out what is only a part: a field without z, a roll without pitch."""
    roles = {column.role for column in columns}
    partial = {role for group in GROUPS if not set(group) <= roles for role in group}
    return [column for column in columns if column.role not in partial]


def _require_needed(columns: Sequence[Column], table: TextTable) -> None:
    roles = {column.role for column in columns}
    missing = [role for role in NEEDED if role not in roles]
    if missing:
        raise RecordingError(
            f"no column was found for {', '.join(missing)} (a force, g rate); {_listed(table)}; "
            f"name them: --columns {missing[0]}=NAME_OR_NUMBER,..."
        )


def _listed(table: TextTable) -> str:
    if not table.names:
        return f"it has {table.width} columns without names"
    shown = ", ".join(name[:40] for name in table.names[:MAX_SHOWN])
    more = table.width - min(table.width, MAX_SHOWN)
    return f"it has {shown}" + (f" and {more} more" if more else "")


def _by_numbers(values: Vector | None, taken: set[int]) -> tuple[list[Column], tuple[str, ...]]:
    """Tell six or seven nameless columns apart: time rises, the force is steady in magnitude."""
    if values is None or taken or values.shape[1] not in (6, 7) or len(values) < 2:
        width = 0 if values is None else values.shape[1]
        raise RecordingError(
            f"it has {width} columns without names; 6 (force, rate) and 7 (time first or last) "
            "can be told apart; else name them: --columns t=1,ax=2,ay=3,az=4,gx=5,gy=6,gz=7"
        )
    time = _rising_column(values)
    if time is None and values.shape[1] == 7:
        raise RecordingError(
            "it has 7 columns without names, and neither the first nor the last rises as a time "
            "does; name them: --columns ax=1,ay=2,az=3,gx=4,gy=5,gz=6"
        )
    places = [place for place in range(values.shape[1]) if place != time]
    first, second = places[:3], places[3:]
    force, rate = (first, second) if _force_first(values, first, second) else (second, first)
    order = dict(zip(NEEDED, (*force, *rate), strict=True)) | ({} if time is None else {"t": time})
    columns = [Column(role=r, place=p, name=f"column {p + 1}") for r, p in order.items()]
    said = f"columns {force[0] + 1} to {force[2] + 1} are the force: its magnitude is the steadier"
    timed = () if time is None else (f"column {time + 1} is the time: it rises",)
    return columns, (said, *timed)


def _rising_column(values: Vector) -> int | None:
    if values.shape[1] != 7:
        return None
    for place in (0, 6):
        steps = np.diff(values[:, place])
        if (steps >= 0.0).mean() > 0.99 and steps.sum() > 0.0:
            return place
    return None


def _force_first(values: Vector, first: Sequence[int], second: Sequence[int]) -> bool:
    spreads = []
    for places in (first, second):
        norm = np.linalg.norm(values[:, list(places)], axis=1)
        median = float(np.median(norm))
        spread = float(np.median(np.abs(norm - median)))
        spreads.append(spread / median if median > 0.0 else np.inf)
    if not (spreads[0] * STEADIER < spreads[1] or spreads[1] * STEADIER < spreads[0]):
        raise RecordingError(
            "it has no header, and force and rate cannot be told apart by their magnitudes; name "
            "the columns: --columns ax=1,ay=2,az=3,gx=4,gy=5,gz=6"
        )
    return spreads[0] < spreads[1]
