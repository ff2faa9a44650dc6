"""Records as the JSON that the page reads: degrees beside radians, null for what is no number."""

import json
import math
from collections.abc import Sequence
from dataclasses import fields, is_dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.monitor.snapshot import Batch, Snapshot
from hostkit.records import Axis

TIME_DIGITS = 6
ANGLE_DIGITS = 4
RESIDUAL_DIGITS = 6
"""A residual is often thousandths of the angle, so it keeps more decimals."""

DEGREE_SUFFIXES = (("_rad", "_deg"), ("_rad_s", "_deg_s"))


def encode(value: object) -> bytes:
    """Return a value as JSON in ASCII: a lone surrogate from a device cannot break it."""
    return json.dumps(plain(value), allow_nan=False, separators=(",", ":")).encode("ascii")


def plain(value: object) -> object:
    """Turn records, tuples and numpy scalars into what JSON has.

    A field that ends in ``_rad`` is followed by the same in degrees.
    """
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if value is None or isinstance(value, str | int):
        return value
    if isinstance(value, dict):
        return {str(key): plain(entry) for key, entry in value.items()}
    if isinstance(value, tuple | list):
        return [plain(entry) for entry in value]
    if is_dataclass(value):
        return _record(value)
    raise TypeError(f"a {type(value).__name__} has no form on the page")


def _record(record: object) -> dict[str, object]:
    result: dict[str, object] = {}
    # Only called with what is_dataclass was true of, which mypy does not see here.
    for name in (field.name for field in fields(record)):  # type: ignore[arg-type]
        value = getattr(record, name)
        result[name] = plain(value)
        in_degrees = _in_degrees(name)
        if in_degrees:
            result[in_degrees] = None if value is None else plain(math.degrees(value))
    return result


def _in_degrees(name: str) -> str:
    for suffix, other in DEGREE_SUFFIXES:
        if name.endswith(suffix):
            return name.removesuffix(suffix) + other
    return ""


def encode_snapshot(snapshot: Snapshot) -> bytes:
    """Return a snapshot without its closing brace and `missed_batches`, which differ by client."""
    entries = plain(snapshot)
    assert isinstance(entries, dict)
    del entries["missed_batches"]
    return json.dumps(entries, allow_nan=False, separators=(",", ":")).encode("ascii")[:-1]


def encode_samples(batch: Batch, axes: Sequence[Axis]) -> bytes:
    """Return the samples of a batch as JSON, a list for each quantity of each axis."""
    entries: dict[str, object] = {
        "epoch": batch.epoch,
        "t": _numbers(batch.time_s, TIME_DIGITS),
        "mismatch": batch.mismatch.astype(np.uint8).tolist(),
        "begins": batch.begins.astype(np.uint8).tolist(),
        "received_ms": _numbers(np.array([batch.received_s * 1000.0]), 3)[0],
    }
    device = np.degrees(batch.device_rad)
    model = np.degrees(batch.model_rad)
    residual = np.degrees(batch.residual_rad)
    for column, axis in enumerate(axes):
        entries[axis] = {
            "device": _numbers(device[:, column], ANGLE_DIGITS),
            "model": _numbers(model[:, column], ANGLE_DIGITS),
            "residual": _numbers(residual[:, column], RESIDUAL_DIGITS),
        }
    return json.dumps(entries, allow_nan=False, separators=(",", ":")).encode("ascii")


def _numbers(column: NDArray[np.float64], digits: int) -> list[float | None]:
    rounded = np.round(column, digits)
    finite = np.isfinite(rounded)
    values: list[float | None] = rounded.tolist()
    if finite.all():
        return values
    return [value if good else None for value, good in zip(values, finite.tolist(), strict=True)]
