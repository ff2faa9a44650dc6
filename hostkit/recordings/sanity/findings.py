"""One finding of the sanity card."""

from dataclasses import dataclass
from typing import Literal

Kind = Literal[
    "gap", "jitter", "rate", "held", "clipping", "sign", "bias", "force", "reference", "valid"
]


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """Something about a recording that deserves a second look, and what to do about it."""

    kind: Kind
    message: str
