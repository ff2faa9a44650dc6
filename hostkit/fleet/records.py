"""The frozen records of a fleet: what is asked of each device, and what came out."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from hostkit.design_file import digest
from hostkit.filters import FILTERS
from hostkit.filters.filter import Fact
from hostkit.records import FilterDesign
from hostkit.tuning import TuningOptions

GroupBy = Literal["folder", "prefix"]
Status = Literal["ok", "failed", "skipped"]

GROUP_RULES: tuple[GroupBy, ...] = ("folder", "prefix")
STATUSES: tuple[Status, ...] = ("ok", "failed", "skipped")

MOST_CHARACTERS = 400
"""Of a reason; a longer one is cut."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Device:
    """One device of a fleet and its recordings, in order of name.

    `fault` says why it cannot be tuned at all; it is empty for a sound one.
    """

    name: str
    files: tuple[Path, ...]
    fault: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorWish:
    """Settings of the sensor that hold for every device; None lets its recordings decide."""

    gyro_full_scale_deg_s: int | None = None
    accel_full_scale_g: int | None = None
    low_pass_setting: int | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class FleetOptions:
    """What the user decides about a fleet.

    Attributes
    ----------
    tuning
        How each device is tuned; all have the same seed, so none depends on its neighbours.
    group_by
        ``folder``: each sub-folder is a device. ``prefix``: files of one folder, and the name up
        to the first underscore is the device.
    redo
        Tune again what is unchanged, and replace designs that were edited.
    """

    tuning: TuningOptions = field(default_factory=TuningOptions)
    wish: SensorWish = field(default_factory=SensorWish)
    group_by: GroupBy = "folder"
    redo: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Job:
    """One device to tune: all that a worker is sent. `folder` is the fleet's, absolute."""

    device: str
    folder: Path
    files: tuple[Path, ...]
    tuning: TuningOptions
    wish: SensorWish


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """What a worker sends back: a design, or the one line that says why there is none."""

    device: str
    design: FilterDesign | None = None
    error: str = ""
    remarks: tuple[str, ...] = ()
    seconds: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class DeviceResult:
    """One device in the summary.

    Attributes
    ----------
    recordings
        How many files it has.
    digest, rmse_deg
        Of its design, the second on its own recordings; None where there is none.
    facts
        What its filter tells of the design.
    error
        One line, empty unless it failed.
    """

    device: str
    status: Status
    recordings: int
    digest: str | None = None
    rmse_deg: float | None = None
    facts: tuple[Fact, ...] = ()
    error: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Step:
    """One finished device, for whoever watches; `seconds` is None where nothing was tuned."""

    result: DeviceResult
    done: int
    total: int
    remarks: tuple[str, ...] = ()
    seconds: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class FleetResult:
    """All devices in order of name."""

    devices: tuple[DeviceResult, ...]

    @property
    def fact_names(self) -> tuple[str, ...]:
        """Names of the facts that some device has, in their order."""
        return tuple(dict.fromkeys(fact.name for d in self.devices for fact in d.facts))

    def of(self, status: Status) -> tuple[DeviceResult, ...]:
        """Return the devices of one status."""
        return tuple(d for d in self.devices if d.status == status)


def failed(device: str, recordings: int, error: str) -> DeviceResult:
    """Return the result of a device that has no new design."""
    return DeviceResult(device=device, status="failed", recordings=recordings, error=error)


def designed(device: str, status: Status, recordings: int, design: FilterDesign) -> DeviceResult:
    """Return the result of a device that has a design."""
    return DeviceResult(
        device=device,
        status=status,
        recordings=recordings,
        digest=digest(design),
        rmse_deg=None if design.tuning is None else design.tuning.rmse_deg,
        facts=FILTERS[design.filter].facts(design),
    )


def one_line(text: str) -> str:
    """Return a text on one line, not longer than a reader wants."""
    line = " ".join(text.split())
    return line if len(line) <= MOST_CHARACTERS else line[: MOST_CHARACTERS - 3] + "..."
