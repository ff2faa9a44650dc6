"""What MCAP and rosbag share: messages of type sensor_msgs/Imu become a log.

Axes are those of REP 145: x forward, y left, z up, the force is +g on the axis that points up, and
the orientation is sensor to world with world z up: hostkit's own.
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from hostkit.errors import RecordingError
from hostkit.importers.log import MAX_SAMPLES, ReferenceTrack, SensorLog
from hostkit.importers.timebase import seconds

IMU_TYPES = ("sensor_msgs/msg/Imu", "sensor_msgs/Imu")
NOT_GIVEN = -1.0
"""What stands first in a covariance if the quantity is not measured (sensor_msgs/Imu)."""


@dataclass(slots=True)
class ImuRows:
    """Messages of one topic, as they come."""

    stamp_ns: list[int] = field(default_factory=list)
    log_ns: list[int] = field(default_factory=list)
    rate: list[tuple[float, float, float]] = field(default_factory=list)
    force: list[tuple[float, float, float]] = field(default_factory=list)
    attitude: list[tuple[float, float, float, float]] = field(default_factory=list)

    def add(self, message: Any, log_ns: int) -> None:
        """Take one message, received at `log_ns`.

        Raises
        ------
        RecordingError
            If it says that rate or force is not measured, or there are too many.
        """
        if len(self.stamp_ns) >= MAX_SAMPLES:
            raise RecordingError(f"it has more than {MAX_SAMPLES} samples; cut it into parts")
        for name in ("angular_velocity", "linear_acceleration"):
            if getattr(message, f"{name}_covariance")[0] == NOT_GIVEN:
                raise RecordingError(
                    f"message {len(self.stamp_ns) + 1}: {name} is marked as not measured "
                    "(covariance -1); take another topic: --topic NAME"
                )
        stamp = message.header.stamp
        self.stamp_ns.append(stamp.sec * 10**9 + stamp.nanosec)
        self.log_ns.append(log_ns)
        rate, force, q = (
            message.angular_velocity,
            message.linear_acceleration,
            message.orientation,
        )
        self.rate.append((rate.x, rate.y, rate.z))
        self.force.append((force.x, force.y, force.z))
        known = message.orientation_covariance[0] != NOT_GIVEN
        self.attitude.append((q.w, q.x, q.y, q.z) if known else (np.nan,) * 4)

    def log(self, topic: str, reference: bool) -> SensorLog:
        """Return the log; the orientation is its reference where one was given."""
        if not self.stamp_ns:
            raise RecordingError(f"the topic {topic} has no messages")
        said = []
        ticks = np.array(self.stamp_ns, dtype=np.int64)
        if not ticks.any():
            ticks = np.array(self.log_ns, dtype=np.int64)
            said.append("the messages have no time stamp; time is that of their recording")
        time_s = seconds(ticks, 1e9, int(ticks[0]))
        attitude = np.array(self.attitude, dtype=np.float64)
        given = bool((np.linalg.norm(np.nan_to_num(attitude), axis=1) > 0.0).any())
        track = None
        if given and reference:
            track = ReferenceTrack(time_s=time_s.copy(), quaternion_wxyz=attitude)
            said.append(f"the reference is the orientation in {topic}, an estimate of its sender")
        return SensorLog(
            time_s=time_s,
            angular_rate_rad_s=np.array(self.rate, dtype=np.float64),
            specific_force_m_s2=np.array(self.force, dtype=np.float64),
            reference=track,
            sensor=f"ROS topic {topic}",
            guessed=tuple(said),
        )


def choose_topic(topics: list[str], wanted: str | None) -> str:
    """Return the topic to import.

    Raises
    ------
    RecordingError
        If there is none, several and none was named, or no such one.
    """
    listed = ", ".join(sorted(topics)) or "none"
    if wanted is not None and wanted not in topics:
        raise RecordingError(f"it has no IMU topic {wanted}; it has: {listed}")
    if wanted is None and len(topics) != 1:
        what = "no topic" if not topics else "several topics"
        raise RecordingError(
            f"it has {what} of type {IMU_TYPES[0]}: {listed}"
            + ("; say --topic NAME" if topics else "")
        )
    return wanted if wanted is not None else topics[0]
