"""The options of ``tune`` that name filter parameters, in the units of the screen."""

import math

import click

from hostkit.tuning import TUNERS, FixedParameter, FreeName, SearchRange
from hostkit.tuning.tuner import Tunable, Tuner

ALL = "all"
FILTER_OPTION = "filter_name"
AUTO_FILTER = "auto"
"""The filter that the recordings call for; which parameters it has is not known before."""


def parse_free(
    ctx: click.Context, option: click.Parameter, text: str | None
) -> tuple[FreeName, ...]:
    """Read names of parameters, separated by commas, or ``all``; nothing leaves it open."""
    if text is None:
        return ()
    tuner = _tuner(ctx)
    if text == ALL:
        return tuple(t.name for t in tuner.tunables)
    return tuple(_known(tuner, part.strip()).name for part in text.split(","))


def parse_fixed(
    ctx: click.Context, option: click.Parameter, texts: tuple[str, ...]
) -> tuple[FixedParameter, ...]:
    """Read ``NAME=VALUE`` or ``NAME-AXIS=VALUE`` into the units of a design."""
    return tuple(_fixed(_tuner(ctx), text) for text in texts)


def parse_ranges(
    ctx: click.Context, option: click.Parameter, texts: tuple[str, ...]
) -> tuple[SearchRange, ...]:
    """Read ``NAME=LOW:HIGH`` into the units of a design."""
    return tuple(_range(_tuner(ctx), text) for text in texts)


def _tuner(ctx: click.Context) -> Tuner:
    name = ctx.params[FILTER_OPTION]
    if name == AUTO_FILTER:
        raise click.BadParameter(f"name the filter with --filter: {', '.join(TUNERS.names())}")
    return TUNERS[name]


def _fixed(tuner: Tuner, text: str) -> FixedParameter:
    name, _, value = text.partition("=")
    stem, _, last = name.rpartition("-")
    axis: str | None = None
    if last in {axis for t in tuner.tunables for axis in t.axes}:
        axis, name = last, stem
    known = _known(tuner, name)
    if axis is not None and axis not in known.axes:
        raise click.BadParameter(f"{name} is one for all axes")
    return FixedParameter(name=known.name, value=_number(value) / known.shown_per_unit, axis=axis)


def _range(tuner: Tuner, text: str) -> SearchRange:
    name, _, ends = text.partition("=")
    known = _known(tuner, name)
    low, colon, high = ends.partition(":")
    if not colon:
        raise click.BadParameter(f"{text!r} is not NAME=LOW:HIGH")
    lowest, highest = (_number(end) / known.shown_per_unit for end in (low, high))
    is_log = known.search.is_log
    if lowest >= highest or (is_log and lowest <= 0.0):
        least = ", the lower one above 0" if is_log else ""
        raise click.BadParameter(
            f"{name} from {low} to {high}: the lower end must be below the upper one{least}"
        )
    return SearchRange(name=known.name, lowest=lowest, highest=highest, is_log=is_log)


def _known(tuner: Tuner, name: str) -> Tunable:
    found = tuner.tunable(name.replace("-", "_"))
    if found is None or "_" in name:
        known = ", ".join(_option_name(t.name) for t in tuner.tunables)
        raise click.BadParameter(
            f"{name!r} is no parameter of the {tuner.name} filter; known are: {known}"
        )
    return found


def _option_name(name: FreeName) -> str:
    return name.replace("_", "-")


def _number(text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise click.BadParameter(f"{text!r} is not a finite number")
    return number


def described() -> str:
    """Return the parameters of all filters as on the command line, with their units."""
    return "; ".join(
        f"{tuner.name}: "
        + ", ".join(f"{_option_name(t.name)} ({t.shown_unit or 'no unit'})" for t in tuner.tunables)
        for tuner in TUNERS
    )


FILTER = click.option(
    "--filter",
    FILTER_OPTION,
    type=click.Choice((*TUNERS.names(), AUTO_FILTER)),
    default="complementary",
    show_default=True,
    is_eager=True,
    help="Filter to tune; auto is the one that the motion of the recordings calls for.",
)
FREE = click.option(
    "--free",
    callback=parse_free,
    metavar="NAMES",
    help="Parameters to tune, separated by commas, or 'all'. By default "
    + "; ".join(f"{t.name}: {','.join(map(_option_name, t.free))}" for t in TUNERS)
    + ".",
)
FIX = click.option(
    "--fix",
    "fixed",
    callback=parse_fixed,
    multiple=True,
    metavar="NAME=VALUE",
    help=f"Set a parameter instead; may be repeated. Parameters and units: {described()}.",
)
RANGE = click.option(
    "--range",
    "ranges",
    callback=parse_ranges,
    multiple=True,
    metavar="NAME=LOW:HIGH",
    help="Search a parameter here, in the same units; may be repeated.",
)
