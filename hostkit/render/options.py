"""What one may choose of the firmware beside its design: who it is, what it sends, how it works."""

import math
from dataclasses import dataclass
from typing import Final, Literal, get_args

from hostkit.errors import RenderError

Profile = Literal["gcs", "component"]
Arithmetic = Literal["fixed", "float"]
Acquisition = Literal["burst", "fifo"]

SAMPLE_MESSAGES: Final = (
    *("TILT_SAMPLE", "TILT_STATE", "ATTITUDE"),
    *("SCALED_IMU", "RAW_IMU", "HIGHRES_IMU"),
)
"""Messages that go out with a sample, in the order in which they are sent."""
TIMED_MESSAGES: Final = ("SYS_STATUS", "HEARTBEAT")
"""Messages that go out by the clock."""
STREAMED_MESSAGES: Final = (*SAMPLE_MESSAGES, *TIMED_MESSAGES)
TIMED_MAX_HZ: Final = 10.0
HEARTBEAT_MIN_HZ: Final = 0.5
"""Ground stations give a device up after some seconds without a heartbeat."""
SYSTEM_IDS: Final = (1, 254)
TAKEN_SYSTEM_IDS: Final = {250: "a companion's usual one", 255: "the ground station's usual one"}
BAUD_LIMITS: Final = (1200, 4_000_000)


@dataclass(frozen=True, slots=True, kw_only=True)
class Identity:
    """What a device calls itself in its heartbeat, and its component id."""

    component_id: int
    vehicle_type: int
    autopilot: int


IDENTITIES: Final[dict[Profile, Identity]] = {
    "gcs": Identity(component_id=1, vehicle_type=0, autopilot=0),
    "component": Identity(component_id=200, vehicle_type=40, autopilot=8),
}
"""``gcs``: type GENERIC, autopilot GENERIC, component AUTOPILOT1, as ground stations show a lone
board. ``component``: type IMU, autopilot INVALID, component IMU, as minimal.xml
of MAVLink wants it of whatever steers no vehicle."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MessageRate:
    """How often a streamed message goes out, Hz; 0 is never."""

    name: str
    rate_hz: float

    def __post_init__(self) -> None:
        """Refuse what is not streamed, and rates that no clock or receiver stands."""
        if self.name not in STREAMED_MESSAGES:
            raise RenderError(
                f"{self.name!r} is no streamed message; there are: {', '.join(STREAMED_MESSAGES)}"
            )
        if not (math.isfinite(self.rate_hz) and self.rate_hz >= 0.0):
            raise RenderError(f"{self.name} = {self.rate_hz} Hz; it must be 0, for off, or more")
        if self.name in TIMED_MESSAGES and self.rate_hz > TIMED_MAX_HZ:
            raise RenderError(f"{self.name} = {self.rate_hz:g} Hz; the limit is {TIMED_MAX_HZ:g}")
        if self.name == "HEARTBEAT" and self.rate_hz < HEARTBEAT_MIN_HZ:
            raise RenderError(
                f"HEARTBEAT = {self.rate_hz:g} Hz; it must be {HEARTBEAT_MIN_HZ:g} to "
                f"{TIMED_MAX_HZ:g} Hz, or ground stations take the device for lost"
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class FirmwareOptions:
    """Choices that leave the filter, and so the digest of the design, as they are.

    Attributes
    ----------
    profile
        Who the device says it is: a vehicle that ground stations show, or a component of one.
    system_id
        MAVLink system id.
    baud
        Rate of the link, bit/s; None is the target's own.
    message_rates
        Those that differ from the defaults, each message once.
    arithmetic
        Whether the filter computes in integers, equal to the model bit for bit, or in float.
    acquisition
        Whether samples are read one by one or out of the sensor's FIFO.
    calibrate_at_start
        Whether the gyroscope's bias is measured after each start, at rest.
    signing
        Whether messages carry a signature; it makes each 13 bytes longer.

    Raises
    ------
    RenderError
        If a value is not among those, or a message is named twice.
    """

    profile: Profile = "gcs"
    system_id: int = 1
    baud: int | None = None
    message_rates: tuple[MessageRate, ...] = ()
    arithmetic: Arithmetic = "fixed"
    acquisition: Acquisition = "burst"
    calibrate_at_start: bool = False
    signing: bool = False

    def __post_init__(self) -> None:
        """Refuse what no firmware can be."""
        require_one_of("profile", self.profile, get_args(Profile))
        require_one_of("arithmetic", self.arithmetic, get_args(Arithmetic))
        require_one_of("acquisition", self.acquisition, get_args(Acquisition))
        require_system_id(self.system_id)
        low, high = BAUD_LIMITS
        if self.baud is not None and not low <= self.baud <= high:
            raise RenderError(f"baud = {self.baud}; it must be {low} to {high} bit/s")
        names = [rate.name for rate in self.message_rates]
        for name in names:
            if names.count(name) > 1:
                raise RenderError(f"the rate of {name} is given {names.count(name)} times")

    @property
    def identity(self) -> Identity:
        """Who the device says it is."""
        return IDENTITIES[self.profile]

    def rate_hz(self, message: str) -> float | None:
        """Return the rate that was chosen for a message, or None if none was."""
        found = [rate.rate_hz for rate in self.message_rates if rate.name == message]
        return found[0] if found else None


def require_one_of(what: str, value: str, known: tuple[str, ...]) -> None:
    """Refuse a word that is not among those known."""
    if value not in known:
        raise RenderError(f"{what} = {value!r}; it must be one of: {', '.join(known)}")


def require_system_id(system_id: int) -> None:
    """Refuse a MAVLink system id that is none, or that others take."""
    low, high = SYSTEM_IDS
    if system_id in TAKEN_SYSTEM_IDS:
        raise RenderError(
            f"system_id = {system_id} is {TAKEN_SYSTEM_IDS[system_id]}; take another of "
            f"{low} to {high}"
        )
    if not low <= system_id <= high:
        raise RenderError(f"system_id = {system_id}; it must be {low} to {high}")


DEFAULT_OPTIONS: Final = FirmwareOptions()
