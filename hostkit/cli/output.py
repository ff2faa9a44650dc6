"""What every subcommand prints with ``--json``: exactly one document on standard output."""

import json
from collections.abc import Mapping

import click


def emit_json(document: Mapping[str, object]) -> None:
    """Print one JSON document, keys in the given order; NaN and infinity are refused."""
    click.echo(json.dumps(document, indent=2, allow_nan=False))
