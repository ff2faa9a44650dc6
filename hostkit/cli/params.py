"""The subcommand ``params``: the parameters of a device."""

from collections.abc import Sequence
from pathlib import Path

import click

from hostkit import __version__
from hostkit.cli.inputs import JSON, say
from hostkit.cli.link_options import LinkChoice, chosen_link, link_options
from hostkit.cli.output import emit_json
from hostkit.cli.params_output import (
    Shown,
    document,
    outcome_rows,
    show_entries,
    show_outcomes,
)
from hostkit.cli.params_secret import secret
from hostkit.errors import HostkitError
from hostkit.link.device.device_link import DeviceLink, SettingOutcome
from hostkit.link.device.parameter_compare import Difference, differences
from hostkit.link.device.parameter_entry import ParameterEntry, as_real32
from hostkit.link.device.parameter_file import read_parameter_file, write_parameter_file

STORED_LATER = "the device stores this when nothing was changed for 3 s; --store does it at once"
FILE = click.argument(
    "file", metavar="F.parm", type=click.Path(exists=True, dir_okay=False, path_type=Path)
)
STORE = click.option("--store", is_flag=True, help="Let the device store the values at once.")


@click.group("params")
@link_options
def params() -> None:
    """Read, set, save, load and compare the parameters of a device.

    The options of the link may stand here or behind the subcommand. The files are those of
    MAVProxy: a name and a value per line.

    \b
    Example:
      hostkit params get --port /dev/ttyUSB0
      hostkit params set FILT_TAU=1.5 --port /dev/ttyUSB0 --store
      hostkit params save bench.parm --port /dev/ttyUSB0
      hostkit params diff bench.parm --port /dev/ttyUSB0
      hostkit params secret bench.key --new --port /dev/ttyUSB0
    """


@params.command("get")
@click.argument("names", nargs=-1, metavar="[NAME...]")
@link_options
@JSON
def get(names: tuple[str, ...], as_json: bool) -> None:
    """Show all parameters, or those of the NAMEs.

    \b
    Example:
      hostkit params get FILT_TAU --port /dev/ttyUSB0 --design design.json
    """
    choice = chosen_link()
    with choice.open() as link:
        entries = _named(link.fetch(), tuple(name.upper() for name in names))
        shown = _shown(choice, link)
    if as_json:
        emit_json(document("get", link, parameters=[shown.row(entry) for entry in entries]))
    else:
        show_entries(entries, shown)


@params.command("set")
@click.argument("settings", nargs=-1, required=True, metavar="NAME=VALUE...")
@STORE
@link_options
@JSON
def set_(settings: tuple[str, ...], store: bool, as_json: bool) -> None:
    """Set parameters and show what the device then uses.

    The device rounds a value to what its filter can hold, and keeps the old one where the new one
    is out of range; that ends with exit code 1.

    \b
    Example:
      hostkit params set FILT_TAU=1.5 TILT_OFS_ROLL=0.01 --port /dev/ttyUSB0
    """
    values = _values(settings)
    choice = chosen_link()
    with choice.open() as link:
        _check(link.fetch(), values, choice)
        _apply("set", link, values, choice, store=store, as_json=as_json)


@params.command("save")
@click.argument("file", metavar="F.parm", type=click.Path(dir_okay=False, path_type=Path))
@link_options
@JSON
def save(file: Path, as_json: bool) -> None:
    """Write all parameters to a file.

    \b
    Example:
      hostkit params save bench.parm --port /dev/ttyUSB0
    """
    choice = chosen_link()
    with choice.open() as link:
        entries = link.fetch()
        shown = _shown(choice, link)
    design = f", design {link.digest}" if link.digest else ""
    remark = f"hostkit {__version__}{design}"
    write_parameter_file(file, [(e.name, e.value) for e in entries], remarks=(remark,))
    if as_json:
        rows = [shown.row(entry) for entry in entries]
        emit_json(document("save", link, file=str(file), parameters=rows))
    else:
        click.echo(f"{len(entries)} parameters in {file}")


@params.command("load")
@FILE
@STORE
@link_options
@JSON
def load(file: Path, store: bool, as_json: bool) -> None:
    """Set the parameters of a file.

    All names and values are checked before the first is set; what the device refuses all the same
    is told, and ends with exit code 1.

    \b
    Example:
      hostkit params load bench.parm --port /dev/ttyUSB0
    """
    rows = read_parameter_file(file)
    values = {row.name: row.value for row in rows}
    choice = chosen_link()
    with choice.open() as link:
        entries = link.fetch()
        _check(entries, values, choice)
        changed = {d.name: values[d.name] for d in differences(entries, rows)}
        if len(changed) < len(values):
            say(f"{len(values) - len(changed)} of {len(values)} values are in use already")
        _apply("load", link, changed, choice, store=store, as_json=as_json)


@params.command("diff")
@FILE
@link_options
@JSON
def diff(file: Path, as_json: bool) -> None:
    """Compare the device with a file; exit code 1 if they differ.

    Values that differ by no more than 0.000001, or FILT_TAU by no more than one step of the
    filter's weight, are equal: MAVProxy writes no more places, and the device has no finer steps.

    \b
    Example:
      hostkit params diff bench.parm --port /dev/ttyUSB0
    """
    rows = read_parameter_file(file)
    choice = chosen_link()
    with choice.open() as link:
        entries = link.fetch()
        shown = _shown(choice, link)
    found = differences(entries, rows, missing=True)
    if as_json:
        emit_json(document("diff", link, file=str(file), differences=[_row(d) for d in found]))
    else:
        for difference in found:
            _show_difference(difference, shown)
    if found:
        names = ", ".join(difference.name for difference in found)
        raise HostkitError(f"the device and {file} differ in {len(found)}: {names}")


params.add_command(secret)


def _shown(choice: LinkChoice, link: DeviceLink) -> Shown:
    rate_hz = None if choice.design is None else choice.design.rate_hz
    return Shown.of(choice.facts(), link, rate_hz)


def _named(entries: Sequence[ParameterEntry], names: tuple[str, ...]) -> list[ParameterEntry]:
    """Return the entries of the names in their order, all if there are none."""
    by_name = {entry.name: entry for entry in entries}
    for name in names:
        if name not in by_name:
            raise HostkitError(f"no parameter {name!r}; the device has: {', '.join(by_name)}")
    return [by_name[name] for name in names] if names else list(entries)


def _values(settings: tuple[str, ...]) -> dict[str, float]:
    """Read NAME=VALUE words."""
    values: dict[str, float] = {}
    for text in settings:
        name, equals, number = text.partition("=")
        name = name.strip().upper()
        try:
            value = float(number)
        except ValueError:
            equals = ""
        if not equals or not name:
            raise click.UsageError(f"{text!r} is not NAME=VALUE, such as FILT_TAU=1.5")
        if name in values:
            raise click.UsageError(f"{name} is given twice")
        values[name] = value
    return values


def _check(entries: Sequence[ParameterEntry], values: dict[str, float], choice: LinkChoice) -> None:
    """Refuse all if one cannot be set: names that the device does not have, values out of range."""
    _named(entries, tuple(values))
    facts = choice.facts()
    for name, value in values.items():
        as_real32(name, value)
        fact = facts.get(name)
        if fact is not None and not fact.takes(value):
            unit = f" {fact.unit}" if fact.unit else ""
            raise HostkitError(
                f"{name} = {value:.9g}{unit}: the device takes {fact.range_text()}; nothing was set"
            )


def _apply(
    action: str,
    link: DeviceLink,
    values: dict[str, float],
    choice: LinkChoice,
    *,
    store: bool,
    as_json: bool,
) -> None:
    """Set values, store them if wanted, show what became of them."""
    outcomes = link.set(values)
    failed = [outcome for outcome in outcomes if outcome.error]
    stored = store and not failed
    if stored:
        link.run("store")
    if as_json:
        emit_json(document(action, link, results=outcome_rows(outcomes), stored=stored))
    else:
        show_outcomes(outcomes, _shown(choice, link))
    _require_all(outcomes, failed)
    if values and not stored:
        say(STORED_LATER)


def _require_all(outcomes: Sequence[SettingOutcome], failed: list[SettingOutcome]) -> None:
    if not failed:
        return
    done = ", ".join(outcome.name for outcome in outcomes if not outcome.error) or "none"
    names = ", ".join(outcome.name for outcome in failed)
    raise HostkitError(f"{len(failed)} of {len(outcomes)} not set: {names}; set: {done}")


def _row(difference: Difference) -> dict[str, object]:
    return {"name": difference.name, "device": difference.device, "file": difference.file}


def _show_difference(difference: Difference, shown: Shown) -> None:
    name = difference.name
    device, file = (
        "none" if value is None else shown.text(name, value)
        for value in (difference.device, difference.file)
    )
    click.echo(f"{name:<16}  device {device}  file {file}")
