"""Registers that tell software which hardware it talks to: constants of the design."""

import re
from typing import Final

from hostkit import __version__
from hostkit.design_file import digest
from hostkit.fixedpoint import QFormat
from hostkit.records import FilterDesign
from hostkit.render.fpga_options import FpgaOptions
from hostkit.render.registers.records import WORD_BYTES, Field, Register
from hostkit.sensors import mpu6050
from hostkit.spec import FixedPointSpec

MAGIC: Final = int.from_bytes(b"HKIT", "big")
MAP_REVISION: Final = 1
"""Raised when an address or a field moves."""

_NO_FORMAT: Final = QFormat(width=18, fraction_bits=0)


def constant_registers(
    design: FilterDesign, spec: FixedPointSpec, options: FpgaOptions
) -> tuple[Register, ...]:
    """Return the registers of constants, from address 0 up."""
    digits = digest(design)
    words = (
        ("IDENTITY", "Always 0x484B4954, HKIT in ASCII.", (_constant("MAGIC", 0, 32, MAGIC),)),
        ("VERSION", "Revision of this map and version of hostkit.", _version(__version__)),
        ("DIGEST_HIGH", "First digits of the design's digest.", _digest(digits[:4])),
        ("DIGEST_LOW", "The other digits.", _digest(digits[4:])),
        ("FEATURES", "What the filter has.", _features(spec, options.channels, options.pipelined)),
        ("SENSOR", "How the sensor is set.", _sensor(design)),
        ("RATE", "Sample rate.", (_constant("MILLIHERTZ", 0, 32, round(1e3 * design.rate_hz)),)),
        ("FORMATS", "Fraction bits of the coefficients.", _formats(spec)),
        ("SCALES", "Weight of the other words.", _scales(spec)),
    )
    return tuple(
        Register(name=name, address=WORD_BYTES * i, description=description, fields=fields)
        for i, (name, description, fields) in enumerate(words)
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


def _features(spec: FixedPointSpec, channels: int, pipelined: bool) -> tuple[Field, ...]:
    flags = (
        ("ROLL", "roll" in spec.axes, "roll is estimated"),
        ("PITCH", "pitch" in spec.axes, "pitch is estimated"),
        ("ARCSIN", spec.tilt == "arcsin", "tilt is the arc sine of one component"),
        ("GATE", spec.gate is not None, "the size of the specific force gates the correction"),
        ("INTEGRAL", spec.integral is not None, "the bias of the gyroscope is estimated"),
        ("PIPELINED", pipelined, "the filter takes a sample every clock"),
    )
    bits = tuple(_constant(name, i, 1, int(has), text) for i, (name, has, text) in enumerate(flags))
    return (*bits, _constant("CHANNELS", 16, 16, channels, "sensors that the filter serves"))


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


def _formats(spec: FixedPointSpec) -> tuple[Field, ...]:
    by_axis = dict(zip(spec.axes, spec.rate_gains, strict=True))
    formats = (
        ("BLEND", spec.blend.format),
        ("RATE_GAIN_ROLL", by_axis["roll"].format if "roll" in by_axis else _NO_FORMAT),
        ("RATE_GAIN_PITCH", by_axis["pitch"].format if "pitch" in by_axis else _NO_FORMAT),
        ("INTEGRAL_GAIN", spec.integral.gain.format if spec.integral else _NO_FORMAT),
    )
    return tuple(
        _constant(name, 8 * i, 8, format_.fraction_bits, f"fraction bits of {name}")
        for i, (name, format_) in enumerate(formats)
    )


def _scales(spec: FixedPointSpec) -> tuple[Field, ...]:
    bits = 0 if spec.integral is None else spec.integral.fraction_bits
    return (
        _constant("BIAS_FRACTION_BITS", 0, 8, bits, "fraction bits of a bias"),
        _constant("GRAVITY_COUNT", 16, 16, spec.gravity_count, "accelerometer count of 1 g"),
    )
