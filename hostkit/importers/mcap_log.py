"""Importer of MCAP files with ROS 2 messages: one topic of type sensor_msgs/Imu."""

from pathlib import Path
from typing import Any

from hostkit.importers.foreign import head, need, reading
from hostkit.importers.log import Importer, Progress, SensorLog
from hostkit.importers.options import ImportOptions
from hostkit.importers.ros_imu import IMU_TYPES, ImuRows, choose_topic

MAGIC = b"\x89MCAP0\r\n"


def sniff(path: Path) -> bool:
    """Tell whether a file begins as an MCAP does."""
    return head(path).startswith(MAGIC)


def read(path: Path, options: ImportOptions, progress: Progress) -> SensorLog:
    """Read one topic.

    Raises
    ------
    RecordingError
        If the file is damaged or was not closed, or the topic is not clear.
    ToolMissingError
        If mcap or mcap-ros2-support is not installed.
    """
    reader_module = need("mcap.reader", "MCAP")
    decoder_module = need("mcap_ros2.decoder", "MCAP")
    rows = ImuRows()
    with reading("MCAP file"), path.open("rb") as stream:
        reader = reader_module.make_reader(
            stream, decoder_factories=[decoder_module.DecoderFactory()]
        )
        summary = reader.get_summary()
        topic = choose_topic(_topics(summary), options.topic)
        total = _messages(summary, topic)
        for _, _, message, imu in reader.iter_decoded_messages(topics=[topic]):
            rows.add(imu, message.log_time)
            progress(len(rows.log_ns), total)
    return rows.log(topic, options.reference)


def _topics(summary: Any) -> list[str]:
    return sorted(
        {
            channel.topic
            for channel in summary.channels.values()
            if channel.schema_id in summary.schemas
            and summary.schemas[channel.schema_id].name in IMU_TYPES
        }
    )


def _messages(summary: Any, topic: str) -> int:
    counts = summary.statistics.channel_message_counts if summary.statistics else {}
    ids = [number for number, channel in summary.channels.items() if channel.topic == topic]
    return max(1, sum(int(counts.get(number, 0)) for number in ids))


IMPORTER = Importer(
    name="mcap",
    title="MCAP with ROS 2 messages",
    suffixes=(".mcap",),
    sniff=sniff,
    read=read,
    uses=frozenset({"topic"}),
)
