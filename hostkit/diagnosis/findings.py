"""A diagnosis in sentences: what was found, and what to do about it."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from hostkit.diagnosis.clipping import Clipping
from hostkit.diagnosis.diagnosis import Diagnosis
from hostkit.diagnosis.force import PERCENTILES, VIBRATION_FROM_HZ
from hostkit.diagnosis.motion_finding import motion_sentence
from hostkit.diagnosis.noise import MIN_STRETCH_S, long_stretches
from hostkit.diagnosis.noise_finding import noise_sentences
from hostkit.diagnosis.recommendation import recommended_filter
from hostkit.recordings.sanity.sensor_findings import MAX_BIAS_DEG_S, MAX_FORCE_ERROR
from hostkit.recordings.sanity.time_findings import GAP_STEPS, MAX_JITTER
from hostkit.units import DEG_PER_RAD, STANDARD_GRAVITY_M_S2

VIBRATION_LIMIT_M_S2 = 0.5
"""Across gravity this tilts the force of a single sample by 3 deg."""
FORCE_SPREAD_LIMIT = 0.01
"""Differences of the force between orientations at rest: 1 % across gravity is 0.6 deg."""
TEMPERATURE_LIMIT_DEG_C = 5.0
GATE_G = 0.1
BIAS_ACTION = (
    "hostkit calibrate imu puts it into the design; the observer also follows what is left of it"
)
SCALE_ACTION = (
    "record the sensor at rest on its six faces for hostkit calibrate imu; of the filters the "
    "observer has a place for offset and scale of the accelerometer"
)
GATE_ACTION = "try --free tau,gate and compare the errors on what was left out"

Level = Literal["ok", "look"]
Topic = Literal[
    "time",
    "range",
    "rest",
    "bias",
    "gravity",
    "temperature",
    "vibration",
    "force",
    "motion",
    "noise",
]


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """One line of a diagnosis.

    Attributes
    ----------
    topic
        What it is about.
    level
        ``look`` if something is to be done before or instead of tuning.
    sentence, action
        What was found; what to do, empty if nothing.
    """

    topic: Topic
    level: Level
    sentence: str
    action: str = ""

    def line(self) -> str:
        """Return the finding as one line of text."""
        mark = "!" if self.level == "look" else " "
        arrow = f" -> {self.action}" if self.action else ""
        return f"{mark} {self.topic:<11} {self.sentence}{arrow}"


def findings(diagnosis: Diagnosis) -> tuple[Finding, ...]:
    """Return what a diagnosis says, line by line."""
    return (
        _time(diagnosis),
        *_range(diagnosis),
        _rest(diagnosis),
        *_bias(diagnosis),
        *_temperature(diagnosis),
        _vibration(diagnosis),
        _force(diagnosis),
        _motion(diagnosis),
        *_noise(diagnosis),
    )


def _time(diagnosis: Diagnosis) -> Finding:
    timing = diagnosis.timing
    jitter = timing.jitter_s / timing.median_s
    text = (
        f"steps of {1e3 * timing.median_s:.4g} ms, jitter {1e3 * timing.jitter_s:.4f} ms rms "
        f"({100.0 * jitter:.2f} %), "
    )
    if timing.gap_count:
        text += (
            f"{timing.gap_count} gap(s) beyond {GAP_STEPS:g} steps, "
            f"the longest {timing.most_s:.3g} s"
        )
        action = "cut the recording at the gaps"
    else:
        text += "no gaps"
        action = ""
    if jitter > MAX_JITTER:
        action = "take the sensor's own time or its data-ready interrupt, not the time of arrival"
    return Finding(topic="time", level="look" if action else "ok", sentence=text, action=action)


def _range(diagnosis: Diagnosis) -> Iterator[Finding]:
    reach = diagnosis.reach
    for clipping in reach.clippings:
        yield Finding(
            topic="range",
            level="look",
            sentence=_clipped(clipping),
            action="record again with a wider range, or with slower motion",
        )
    if not reach.clippings:
        text = (
            f"no axis is clipped; the largest readings are "
            f"{max(reach.largest_rad_s) * DEG_PER_RAD:.4g} deg/s and "
            f"{max(reach.largest_m_s2) / STANDARD_GRAVITY_M_S2:.3g} g"
        )
        yield Finding(topic="range", level="ok", sentence=text)


def _clipped(clipping: Clipping) -> str:
    unit = "deg/s" if clipping.element == "gyro" else "g"
    per_unit = DEG_PER_RAD if unit == "deg/s" else 1.0 / STANDARD_GRAVITY_M_S2
    end = "at no range of the MPU-6050"
    if clipping.full_scale is not None:
        end = f"the end of the range of {clipping.full_scale} {unit}"
    where = f"{clipping.element} {'xyz'[clipping.axis]}"
    return (
        f"{where} stays at {clipping.value * per_unit:.4g} {unit} for "
        f"{100.0 * clipping.share:.2g} % of the samples, {end}"
    )


def _rest(diagnosis: Diagnosis) -> Finding:
    stretches = diagnosis.rest.stretches
    if not stretches:
        return Finding(
            topic="rest",
            level="look",
            sentence="the sensor is never at rest for two seconds",
            action="begin the recording with some seconds of stillness, which show the bias",
        )
    longest_s = max(s.duration_s for s in stretches)
    text = (
        f"at rest for {100.0 * diagnosis.rest.share:.3g} % of the samples, in {len(stretches)} "
        f"stretch(es), the longest {longest_s:.3g} s"
    )
    return Finding(topic="rest", level="ok", sentence=text)


def _bias(diagnosis: Diagnosis) -> Iterator[Finding]:
    rest = diagnosis.rest
    if rest.bias_rad_s is None or rest.bias_uncertainty_rad_s is None or rest.force_error is None:
        return
    pairs = zip(rest.bias_rad_s, rest.bias_uncertainty_rad_s, strict=True)
    shown = [f"{b * DEG_PER_RAD:+.4f} +- {u * DEG_PER_RAD:.4f}" for b, u in pairs]
    large = max(map(abs, rest.bias_rad_s)) * DEG_PER_RAD > MAX_BIAS_DEG_S
    yield Finding(
        topic="bias",
        level="look" if large else "ok",
        sentence=f"the gyroscope reads {', '.join(shown)} deg/s at rest (x, y, z)",
        action=BIAS_ACTION if large else "",
    )
    uneven = abs(rest.force_error) > MAX_FORCE_ERROR or rest.force_spread > FORCE_SPREAD_LIMIT
    yield Finding(
        topic="gravity",
        level="look" if uneven else "ok",
        sentence=(
            f"at rest the force is {100.0 * rest.force_error:+.2f} % off gravity and differs by "
            f"{100.0 * rest.force_spread:.2f} % between the stretches"
        ),
        action=SCALE_ACTION if uneven else "",
    )


def _temperature(diagnosis: Diagnosis) -> Iterator[Finding]:
    if diagnosis.temperature_deg_c is None:
        return
    least, most = diagnosis.temperature_deg_c
    wide = most - least > TEMPERATURE_LIMIT_DEG_C
    yield Finding(
        topic="temperature",
        level="look" if wide else "ok",
        sentence=f"{least:.1f} to {most:.1f} degC",
        action="let the sensor warm up first: its bias follows the temperature" if wide else "",
    )


def _vibration(diagnosis: Diagnosis) -> Finding:
    force = diagnosis.force
    if force.vibration_m_s2 is None or force.vibration_total_m_s2 is None:
        text = f"too short, or sampled too slowly, to show anything above {VIBRATION_FROM_HZ:g} Hz"
        return Finding(topic="vibration", level="ok", sentence=text)
    x, y, z = force.vibration_m_s2
    strong = force.vibration_total_m_s2 > VIBRATION_LIMIT_M_S2
    text = (
        f"{force.vibration_total_m_s2:.3g} m/s^2 rms above {VIBRATION_FROM_HZ:g} Hz "
        f"(x {x:.3g}, y {y:.3g}, z {z:.3g})"
    )
    action = "damp the mounting, or take a lower low-pass setting" if strong else ""
    return Finding(
        topic="vibration", level="look" if strong else "ok", sentence=text, action=action
    )


def _force(diagnosis: Diagnosis) -> Finding:
    half, *_, most, _ = diagnosis.force.deviation_percentiles_g
    recommended = recommended_filter(diagnosis)
    gated = recommended is None or recommended.filter == "complementary"
    moved = most > GATE_G and gated
    text = (
        f"| |f| - 1 g | is up to {half:.3f} g for {PERCENTILES[0]:g} % and up to {most:.3f} g for "
        f"{PERCENTILES[-2]:g} % of the samples"
    )
    action = GATE_ACTION if moved else ""
    return Finding(topic="force", level="look" if moved else "ok", sentence=text, action=action)


def _motion(diagnosis: Diagnosis) -> Finding:
    text, action = motion_sentence(diagnosis)
    return Finding(topic="motion", level="look" if action else "ok", sentence=text, action=action)


def _noise(diagnosis: Diagnosis) -> Iterator[Finding]:
    if diagnosis.noise is not None:
        for text in noise_sentences(diagnosis.noise):
            yield Finding(topic="noise", level="ok", sentence=text)
    elif not long_stretches(diagnosis.rest):
        text = f"no rest of {MIN_STRETCH_S:g} s, so no Allan deviation"
        yield Finding(topic="noise", level="ok", sentence=text)
