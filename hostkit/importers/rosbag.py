"""Importer of rosbags: a ROS 1 ``.bag``, the folder of a rosbag2, or its ``.db3``."""

from pathlib import Path

from hostkit.importers.foreign import head, need, reading
from hostkit.importers.log import Importer, Progress, SensorLog
from hostkit.importers.options import ImportOptions
from hostkit.importers.ros_imu import IMU_TYPES, ImuRows, choose_topic

MAGICS = (b"#ROSBAG V2.0", b"SQLite format 3\0")
METADATA = "metadata.yaml"


def sniff(path: Path) -> bool:
    """Tell whether it is a ROS 1 bag, an SQLite file, or a folder with the data of a rosbag2."""
    return head(path).startswith(MAGICS) or (path / METADATA).is_file()


def read(path: Path, options: ImportOptions, progress: Progress) -> SensorLog:
    """Read one topic.

    Raises
    ------
    RecordingError
        If the bag is damaged, or the topic is not clear.
    ToolMissingError
        If rosbags is not installed.
    """
    highlevel = need("rosbags.highlevel", "rosbag")
    typesys = need("rosbags.typesys", "rosbag")
    rows = ImuRows()
    with reading("rosbag"):
        known = typesys.get_typestore(typesys.Stores.LATEST)
        with highlevel.AnyReader([path], default_typestore=known) as bag:
            imus = [c for c in bag.connections if c.msgtype in IMU_TYPES]
            topic = choose_topic(sorted({c.topic for c in imus}), options.topic)
            chosen = [c for c in imus if c.topic == topic]
            total = max(1, sum(c.msgcount for c in chosen))
            for connection, time_ns, raw in bag.messages(connections=chosen):
                rows.add(bag.deserialize(raw, connection.msgtype), time_ns)
                progress(len(rows.log_ns), total)
    return rows.log(topic, options.reference)


IMPORTER = Importer(
    name="rosbag",
    title="ROS 1 bag or rosbag2",
    suffixes=(".bag", ".db3"),
    sniff=sniff,
    read=read,
    uses=frozenset({"topic"}),
)
