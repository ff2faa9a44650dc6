"""Registers that tell software which hardware it talks to: constants of the design."""

import re
from typing import Final

from hostkit import __version__
from hostkit.design_file import digest
from hostkit.errors import RenderError
from hostkit.filters.core import CoreFacts, WordFormat
from hostkit.records import FilterDesign
from hostkit.render.fpga_options import FpgaOptions
from hostkit.render.registers.records import WORD_BYTES, Field, Register
from hostkit.sensors import mpu6050
from hostkit.spec import FixedPointSpec

MAGIC: Final = int.from_bytes(b"HKIT", "big")
MAP_REVISION: Final = 1
"""Raised when an address or a field moves."""

FIRST_FEATURES: Final = (2, 5)
"""Bits of FEATURES for what the filter tells, up to the one of PIPELINED; then those behind it."""
FEATURE_BITS: Final = (*range(*FIRST_FEATURES), *range(FIRST_FEATURES[1] + 1, 16))
FORMATS_A_WORD: Final = 4
MOST_FORMATS: Final = FORMATS_A_WORD + 2
"""Those of FORMATS, and two in SCALES."""


def constant_registers(
    design: FilterDesign, spec: FixedPointSpec, options: FpgaOptions, core: CoreFacts
) -> tuple[Register, ...]:
    """Return the registers of constants, from address 0 up.

    Raises
    ------
    RenderError
        If the filter tells more of its core than there is room for.
    """
    _require_room(spec, "features", len(core.features), len(FEATURE_BITS))
    _require_room(spec, "formats", len(core.formats), MOST_FORMATS)
    first = core.formats[:FORMATS_A_WORD]
    digits = digest(design)
    words = (
        ("IDENTITY", "Always 0x484B4954, HKIT in ASCII.", (_constant("MAGIC", 0, 32, MAGIC),)),
        ("VERSION", "Revision of this map and version of hostkit.", _version(__version__)),
        ("DIGEST_HIGH", "First digits of the design's digest.", _digest(digits[:4])),
        ("DIGEST_LOW", "The other digits.", _digest(digits[4:])),
        ("FEATURES", "What the filter has.", _features(spec, options, core)),
        ("SENSOR", "How the sensor is set.", _sensor(design)),
        ("RATE", "Sample rate.", (_constant("MILLIHERTZ", 0, 32, round(1e3 * design.rate_hz)),)),
        ("FORMATS", "Fraction bits of the coefficients.", _formats(first)),
        ("SCALES", "Weight of the other words.", _scales(spec, core)),
    )
    return tuple(
        Register(name=name, address=WORD_BYTES * i, description=description, fields=fields)
        for i, (name, description, fields) in enumerate(words)
        if fields
    )


def _constant(name: str, low: int, width: int, value: int, description: str = "") -> Field:
    return Field(
        name=name,
        description=description or name.lower().replace("_", " "),
        low=low,
        width=width,
        source="constant",
        reset=value,
    )


def _version(version: str) -> tuple[Field, ...]:
    major, minor, patch = [*(int(part) for part in re.findall(r"\d+", version)), 0, 0, 0][:3]
    return (
        _constant("PATCH", 0, 8, patch),
        _constant("MINOR", 8, 8, minor),
        _constant("MAJOR", 16, 8, major),
        _constant("REVISION", 24, 8, MAP_REVISION, "revision of the map; it moves with an address"),
    )


def _digest(digits: str) -> tuple[Field, ...]:
    return (_constant("DIGITS", 0, 4 * len(digits), int(digits, 16), f"{len(digits)} hex digits"),)


def _require_room(spec: FixedPointSpec, what: str, needed: int, room: int) -> None:
    if needed > room:
        raise RenderError(
            f"the filter {spec.filter} tells {needed} {what} of its core; the registers have room "
            f"for {room}"
        )


def _features(spec: FixedPointSpec, options: FpgaOptions, core: CoreFacts) -> tuple[Field, ...]:
    flags = [
        (0, "ROLL", "roll" in spec.axes, "roll is estimated"),
        (1, "PITCH", "pitch" in spec.axes, "pitch is estimated"),
        (5, "PIPELINED", options.pipelined, "the filter takes a sample every clock"),
    ]
    for bit, feature in zip(FEATURE_BITS, core.features, strict=False):
        flags.append((bit, feature.name, feature.present, feature.title))
    bits = [_constant(name, bit, 1, int(has), text) for bit, name, has, text in sorted(flags)]
    return (
        *bits,
        _constant("CHANNELS", 16, 16, options.channels, "sensors that the filter serves"),
    )


def _sensor(design: FilterDesign) -> tuple[Field, ...]:
    sensor = design.sensor
    divider = next(
        write.value
        for write in mpu6050.configuration(sensor, design.rate_hz)
        if write.register == mpu6050.SMPLRT_DIV
    )
    return (
        _constant("GYRO_FULL_SCALE", 0, 16, sensor.gyro_full_scale_deg_s, "deg/s"),
        _constant("DIVIDER", 16, 8, divider, "SMPLRT_DIV"),
        _constant("ACCEL_FULL_SCALE", 24, 5, sensor.accel_full_scale_g, "g"),
        _constant("LOW_PASS", 29, 3, sensor.low_pass_setting, "DLPF_CFG"),
    )


def _formats(formats: tuple[WordFormat, ...]) -> tuple[Field, ...]:
    return tuple(
        _constant(word.name, 8 * i, 8, word.fraction_bits, word.title)
        for i, word in enumerate(formats)
    )


def _scales(spec: FixedPointSpec, core: CoreFacts) -> tuple[Field, ...]:
    return (
        *_formats(core.formats[FORMATS_A_WORD:]),
        _constant("GRAVITY_COUNT", 16, 16, spec.gravity_count, "accelerometer count of 1 g"),
    )
