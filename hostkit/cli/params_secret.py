"""The subcommand ``params secret``: the secret that a device signs its messages with."""

from dataclasses import replace
from pathlib import Path

import click

from hostkit.cli.inputs import JSON
from hostkit.cli.link_options import LinkChoice, chosen_link, link_options
from hostkit.cli.output import emit_json
from hostkit.cli.params_output import document
from hostkit.errors import HostkitError
from hostkit.link.device.device_link import DeviceLink
from hostkit.link.device.secret import give_secret, remove_secret
from hostkit.link.frames.signing import SigningKey


@click.command("secret")
@click.argument("file", metavar="KEYFILE", type=click.Path(dir_okay=False, path_type=Path))
@click.option("--new", is_flag=True, help="Make KEYFILE, of 32 random bytes, for you alone.")
@click.option("--remove", is_flag=True, help="Take the secret in KEYFILE away from the device.")
@link_options
@JSON
def secret(file: Path, new: bool, remove: bool, as_json: bool) -> None:
    """Give the device the secret in KEYFILE: it then signs, and hears signed messages only.

    The secret goes over the link in the clear: use a cable. A device that has another secret needs
    that one, too, as --signing-key. Its firmware must have been generated with --signing.

    \b
    Example:
      hostkit params secret bench.key --new --port /dev/ttyUSB0
      hostkit monitor design.json --port /dev/ttyUSB0 --signing-key bench.key
      hostkit params secret bench.key --remove --port /dev/ttyUSB0
    """
    if new and remove:
        raise click.UsageError("--new and --remove do not go together")
    _require_file(file, new=new)
    choice = chosen_link()
    key = None if new else SigningKey.read(file)
    present = None if choice.signing_key is None else SigningKey.read(choice.signing_key)
    with _open(choice) as link:
        key = SigningKey.create(file) if key is None else key
        changed = remove_secret(link, key) if remove else give_secret(link, key, present)
    if as_json:
        emit_json(document("secret", link, file=str(file), signed=not remove, changed=changed))
    else:
        click.echo(_said(file, link, remove=remove, changed=changed))


def _require_file(file: Path, *, new: bool) -> None:
    if new and file.exists():
        raise HostkitError(f"{file} is there already and is not written over; leave out --new")
    if not new and not file.exists():
        raise HostkitError(f"{file} is not there; --new makes it")


def _open(choice: LinkChoice) -> DeviceLink:
    """Open the link without a key, to hear whether the device signs."""
    return replace(choice, signing_key=None).open()


def _said(file: Path, link: DeviceLink, *, remove: bool, changed: bool) -> str:
    system, component = link.parameters.target or (0, 0)
    device = f"device {system}/{component}"
    if remove:
        return f"{device} has no secret {'any more; it' if changed else 'anyway; it'} hears anybody"
    return f"{device} {'signs now' if changed else 'signs already'} with the secret in {file}"
