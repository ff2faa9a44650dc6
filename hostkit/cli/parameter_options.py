"""The options of ``tune`` that name filter parameters, in the units of the screen."""

import math
from collections.abc import Iterable

import click

from hostkit.filters.complementary import BY_NAME
from hostkit.records import Axis
from hostkit.tuning import RANGE_BY_NAME, RANGES, FixedParameter, FreeName, SearchRange

FREE_NAMES: dict[str, FreeName] = {r.name.replace("_", "-"): r.name for r in RANGES}
ALL = "all"
AXIS_NAMES: tuple[Axis, ...] = ("roll", "pitch")


def parse_free(ctx: click.Context, option: click.Parameter, text: str) -> tuple[FreeName, ...]:
    """Read names of parameters, separated by commas, or ``all``."""
    if text == ALL:
        return tuple(FREE_NAMES.values())
    return tuple(_known(part.strip()) for part in text.split(","))


def parse_fixed(
    ctx: click.Context, option: click.Parameter, texts: tuple[str, ...]
) -> tuple[FixedParameter, ...]:
    """Read ``NAME=VALUE`` or ``NAME-AXIS=VALUE`` into the units of a design."""
    return tuple(_fixed(text) for text in texts)


def parse_ranges(
    ctx: click.Context, option: click.Parameter, texts: tuple[str, ...]
) -> tuple[SearchRange, ...]:
    """Read ``NAME=LOW:HIGH`` into the units of a design."""
    return tuple(_range(text) for text in texts)


def _fixed(text: str) -> FixedParameter:
    name, _, value = text.partition("=")
    axis: Axis | None = None
    for candidate in AXIS_NAMES:
        if name.endswith(f"-{candidate}"):
            axis, name = candidate, name.removesuffix(f"-{candidate}")
    known = _known(name)
    if axis is not None and (known == "tau" or not BY_NAME[known].per_axis):
        raise click.BadParameter(f"{name} is one for all axes")
    return FixedParameter(name=known, value=_number(value) / _shown_per_unit(known), axis=axis)


def _range(text: str) -> SearchRange:
    name, _, ends = text.partition("=")
    known = _known(name)
    low, colon, high = ends.partition(":")
    if not colon:
        raise click.BadParameter(f"{text!r} is not NAME=LOW:HIGH")
    lowest, highest = (_number(end) / _shown_per_unit(known) for end in (low, high))
    is_log = RANGE_BY_NAME[known].is_log
    if lowest >= highest or (is_log and lowest <= 0.0):
        least = ", the lower one above 0" if is_log else ""
        raise click.BadParameter(
            f"{name} from {low} to {high}: the lower end must be below the upper one{least}"
        )
    return SearchRange(name=known, lowest=lowest, highest=highest, is_log=is_log)


def _known(name: str) -> FreeName:
    if name not in FREE_NAMES:
        raise click.BadParameter(f"{name!r} is no parameter; known are: {', '.join(FREE_NAMES)}")
    return FREE_NAMES[name]


def _number(text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise click.BadParameter(f"{text!r} is not a finite number")
    return number


def _shown_per_unit(name: FreeName) -> float:
    return 1.0 if name == "tau" else BY_NAME[name].shown_per_unit


def described(names: Iterable[FreeName]) -> str:
    """Return names as on the command line, with their units."""
    units = {"tau": "s", **{name: kind.shown_unit for name, kind in BY_NAME.items()}}
    return ", ".join(f"{name.replace('_', '-')} ({units[name] or 'no unit'})" for name in names)


FREE = click.option(
    "--free",
    callback=parse_free,
    default="tau",
    show_default=True,
    metavar="NAMES",
    help=f"Parameters to tune, separated by commas, or 'all': {', '.join(FREE_NAMES)}.",
)
FIX = click.option(
    "--fix",
    "fixed",
    callback=parse_fixed,
    multiple=True,
    metavar="NAME=VALUE",
    help="Set a parameter instead; may be repeated. Units: " + described(FREE_NAMES.values()) + ".",
)
RANGE = click.option(
    "--range",
    "ranges",
    callback=parse_ranges,
    multiple=True,
    metavar="NAME=LOW:HIGH",
    help="Search a parameter here, in the same units; may be repeated.",
)
