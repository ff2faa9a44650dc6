"""Registers of the filter's settings, which become effective together."""

from dataclasses import dataclass
from typing import Final

from hostkit.fixedpoint import COEFFICIENT_BITS
from hostkit.records import Axis
from hostkit.render.registers.records import WORD_BITS, WORD_BYTES, Field, Kind, Register
from hostkit.spec import FixedPointSpec

SETTINGS_ADDRESS: Final = 0x40


@dataclass(frozen=True, slots=True, kw_only=True)
class Setting:
    """One setting of the filter: its element, its raw value in the design, None without it."""

    name: str
    description: str
    raw: int | None
    width: int = WORD_BITS
    kind: Kind = "signed"


def settings_of(spec: FixedPointSpec) -> tuple[Setting, ...]:
    """Return the settings in the order of their addresses."""
    gains = dict(zip(spec.axes, (gain.raw for gain in spec.rate_gains), strict=True))
    return (
        _coefficient("blend", spec.blend.raw, "weight of the measured tilt"),
        _coefficient("rate_gain_roll", gains.get("roll"), "half turns / 2**31 per count"),
        _coefficient("rate_gain_pitch", gains.get("pitch"), "half turns / 2**31 per count"),
        _coefficient(
            "integral_gain",
            None if spec.integral is None else spec.integral.gain.raw,
            "units of bias per half turn / 2**31 of innovation",
        ),
        _by_axis(spec, "tilt_offset", "roll", spec.tilt_offset_raw, "half turns / 2**31"),
        _by_axis(spec, "tilt_offset", "pitch", spec.tilt_offset_raw, "half turns / 2**31"),
        _by_axis(spec, "gyro_bias", "roll", spec.gyro_bias_raw, "half turns / 2**31 per sample"),
        _by_axis(spec, "gyro_bias", "pitch", spec.gyro_bias_raw, "half turns / 2**31 per sample"),
        _gate("gate_lowest", None if spec.gate is None else spec.gate.lowest),
        _gate("gate_highest", None if spec.gate is None else spec.gate.highest),
    )


def _coefficient(name: str, raw: int | None, description: str) -> Setting:
    return Setting(name=name, raw=raw, width=COEFFICIENT_BITS, description=description)


def _by_axis(
    spec: FixedPointSpec, kind: str, axis: Axis, raw: tuple[int, ...], description: str
) -> Setting:
    own = raw[spec.axes.index(axis)] if axis in spec.axes else None
    return Setting(name=f"{kind}_{axis}", raw=own, description=description)


def _gate(name: str, raw: int | None) -> Setting:
    text = "sum of squared counts from which on" if "low" in name else "and up to which"
    return Setting(name=name, raw=raw, kind="unsigned", description=f"{text} the force corrects")


def setting_registers(spec: FixedPointSpec) -> tuple[Register, ...]:
    """Return one register a setting; one that the design lacks is reserved."""
    return tuple(
        Register(
            name=setting.name.upper(),
            address=SETTINGS_ADDRESS + WORD_BYTES * i,
            description=f"Setting: {setting.description}.",
            fields=(
                Field(
                    name="VALUE",
                    description=setting.description,
                    low=0,
                    width=setting.width,
                    access="rw",
                    source="setting",
                    element=setting.name,
                    kind=setting.kind,
                    reset=(setting.raw or 0) % 2**setting.width,
                    present=setting.raw is not None,
                ),
            ),
        )
        for i, setting in enumerate(settings_of(spec))
    )
