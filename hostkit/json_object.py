"""Strict reading of JSON that somebody may have written by hand."""

import math
from typing import Any

from hostkit.errors import DesignError


class JsonObject:
    """A JSON object whose values are taken out by type; every refusal names the key.

    Each method takes the key of a value and raises `DesignError` if the value is not of the kind
    that the method gives.
    """

    def __init__(self, value: object, where: str) -> None:
        if not isinstance(value, dict):
            raise DesignError(f"{where} is {_shown(value)}; it must be an object")
        self._items: dict[str, object] = value
        self._where = where

    def keys(self) -> tuple[str, ...]:
        """Return the keys."""
        return tuple(self._items)

    def has(self, key: str) -> bool:
        """Tell whether a key is there."""
        return key in self._items

    def only(self, names: str) -> None:
        """Refuse keys outside `names`, a list separated by spaces."""
        unknown = sorted(set(self._items) - set(names.split()))
        if unknown:
            raise DesignError(
                f"{self._where} has the unknown key {unknown[0]!r:.80}; it may have: {names}"
            )

    def value(self, key: str) -> object:
        """Return a value of any kind."""
        if key not in self._items:
            raise DesignError(f"{self._where} lacks the key {key!r}")
        return self._items[key]

    def text(self, key: str) -> str:
        """Return a text of at most 1000 characters."""
        value = self.value(key)
        if not isinstance(value, str) or len(value) > 1000:
            raise self._wrong(key, "a text of at most 1000 characters")
        return value

    def name(self, key: str) -> str:
        """Return a text that is a name."""
        value = self.text(key)
        if not value.replace("-", "_").isidentifier() or not value.isascii():
            raise self._wrong(key, "a name of letters, digits, hyphens and underscores")
        return value

    def choice(self, key: str, choices: tuple[Any, ...]) -> Any:
        """Return a value that is one of `choices`."""
        if self.value(key) not in choices:
            raise self._wrong(key, "one of " + ", ".join(choices))
        return self.value(key)

    def number(self, key: str) -> float:
        """Return a finite number."""
        value = self.value(key)
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise self._wrong(key, "a number")
        if abs(value) > 1e18 or not math.isfinite(value):
            raise self._wrong(key, "a finite number")
        return float(value)

    def optional_number(self, key: str) -> float | None:
        """Return a finite number, or None where the key is not there."""
        return self.number(key) if key in self._items else None

    def integer(self, key: str) -> int:
        """Return an integer of 64 bits."""
        value = self.value(key)
        if isinstance(value, bool) or not isinstance(value, int) or abs(value) >= 2**63:
            raise self._wrong(key, "an integer of 64 bits")
        return value

    def inner(self, key: str) -> "JsonObject":
        """Return an object."""
        return JsonObject(self.value(key), f"{self._where}.{key}")

    def items(self, key: str) -> tuple["JsonObject", ...]:
        """Return the objects of a list."""
        value = self.value(key)
        if not isinstance(value, list):
            raise self._wrong(key, "a list")
        return tuple(JsonObject(v, f"{self._where}.{key}[{i}]") for i, v in enumerate(value))

    def _wrong(self, key: str, wanted: str) -> DesignError:
        shown = _shown(self._items[key])
        return DesignError(f"{self._where}.{key} is {shown}; it must be {wanted}")


def _shown(value: object) -> str:
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."
