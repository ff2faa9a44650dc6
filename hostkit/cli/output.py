"""What every subcommand prints with ``--json``: exactly one document on standard output."""

import json
from collections.abc import Mapping

import click


def json_text(document: Mapping[str, object]) -> str:
    """Return one JSON document, keys in the given order; NaN and infinity are refused."""
    return json.dumps(document, indent=2, allow_nan=False)


def emit_json(document: Mapping[str, object]) -> None:
    """Print one JSON document, keys in the given order; NaN and infinity are refused."""
    click.echo(json_text(document))
