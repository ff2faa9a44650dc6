"""The bounded-velocity observer in integers."""

from dataclasses import dataclass

from hostkit.spec import FixedPointSpec

Triple = tuple[int, int, int]


@dataclass(frozen=True, slots=True, kw_only=True)
class ObserverFormats:
    """Fraction bits of the words; they depend on rate and ranges only.

    Attributes
    ----------
    force
        Specific force, m/s^2.
    correction
        Half-angle that the velocity asks for in a sample, rad; 33 or more.
    bias
        Half-angle that the bias turns in a sample, rad; 32 or more.
    rest_shift
        By how much a half-angle at rest is shifted left before it is multiplied.
    """

    force: int
    correction: int
    bias: int
    rest_shift: int

    @property
    def acceleration_shift(self) -> int:
        """By how much specific force in the earth frame is shifted left, to 24 fraction bits."""
        return 26 - self.force

    @property
    def first_force_shift(self) -> int:
        """By how much the force of the first sample is shifted left, to 27 fraction bits."""
        return 27 - self.force

    @property
    def turn_shift(self) -> int:
        """From a correction to a half-angle with 32 fraction bits."""
        return self.correction - 32

    @property
    def bias_shift(self) -> int:
        """From a bias to a half-angle with 32 fraction bits."""
        return self.bias - 32

    @property
    def first_bias_shift(self) -> int:
        """From the product of a mean of counts and the gain of the gyroscope to a bias."""
        return self.bias - 29


@dataclass(frozen=True, slots=True, kw_only=True)
class ObserverGains:
    """What a running device can change, and the gains of the design beside it.

    Attributes
    ----------
    kt_raw
        Correction per sample and acceleration with 24 fraction bits, times 2**32.
    kv_raw
        Share of the velocity that goes in a sample, times 2**32.
    kb_raw
        Bias per correction, times 2**32; the product has two fraction bits more than a bias.
    bias_raw
        Where the bias of each axis starts.
    """

    kt_raw: int
    kv_raw: int
    kb_raw: int
    bias_raw: Triple


@dataclass(frozen=True, slots=True, kw_only=True)
class ObserverRest:
    """When the sensor is at rest: all in counts with 14 fraction bits.

    Attributes
    ----------
    rate_limit, force_limit
        Largest deviations from the running means.
    gain_raw
        Bias per half-angle, with ``bias - rest_shift`` fraction bits.
    """

    rate_limit: int
    force_limit: int
    gain_raw: int


@dataclass(frozen=True, slots=True, kw_only=True)
class ObserverSpec(FixedPointSpec):
    """A design of the observer in integers.

    Attributes
    ----------
    gyro_gain
        Half-angle per count, 47 fraction bits, one for each axis of the sensor.
    accel_gain
        m/s^2 per count with ``formats.force + 15`` fraction bits.
    accel_offset
        Taken off the scaled force, ``formats.force`` fraction bits.
    acceleration_limit, first_force_limit
        Largest horizontal acceleration (``formats.force - 2`` fraction bits), and force of the
        first sample on each axis (``formats.force`` fraction bits).
    correction_limit, bias_limit
        Largest correction and bias.
    mean_limit
        Largest mean rate that can be a bias, counts with 14 fraction bits, of each axis.
    mean_shift, rest_samples
        Memory of the running means, and when the sensor is at rest.
    start_gain, start_end
        First weight of the alignment, and that at which it is over, 31 fraction bits; 0 and 0
        without it.
    rest
        None where rest is not looked for.
    clip_count
        Largest rate that is not clipped, counts; None where that is not looked at.
    lead_raw
        Lead per half-angle, 25 fraction bits, signed.
    """

    formats: ObserverFormats
    gains: ObserverGains
    gyro_gain: Triple
    accel_gain: Triple
    accel_offset: Triple
    acceleration_limit: int
    first_force_limit: int
    correction_limit: int
    bias_limit: int
    mean_limit: int
    mean_shift: int
    rest_samples: int
    start_gain: int
    start_end: int
    rest: ObserverRest | None
    clip_count: int | None
    lead_raw: int
