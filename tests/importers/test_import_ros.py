"""MCAP files and rosbags, written by mcap-ros2-support and rosbags."""

from collections.abc import Iterable
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from mcap_ros2.writer import Writer as McapWriter
from rosbags.rosbag1 import Writer as Bag1Writer
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Bag2Writer
from rosbags.typesys import Stores, get_typestore

from hostkit.errors import RecordingError
from hostkit.recordings import Recording

IMU = "sensor_msgs/msg/Imu"
START_NS = 1_700_000_000_000_000_000
DEFINITION = """std_msgs/Header header
geometry_msgs/Quaternion orientation
float64[9] orientation_covariance
geometry_msgs/Vector3 angular_velocity
float64[9] angular_velocity_covariance
geometry_msgs/Vector3 linear_acceleration
float64[9] linear_acceleration_covariance
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
================================================================================
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
"""


def attitude(truth: Recording) -> np.ndarray:
    x, y, z = truth.up_reference.T
    w = np.sqrt((1 + z) / 2)
    return np.column_stack((w, y / (2 * w), -x / (2 * w), np.zeros_like(w)))


def plain(truth: Recording, *, stamped: bool = True, known: bool = True) -> Iterable[dict]:
    """Messages as dictionaries, the way the MCAP writer wants them."""
    covariance = [0.0] * 9
    lost = [-1.0] + [0.0] * 8
    for n, q in enumerate(attitude(truth)):
        ns = START_NS + round(truth.time_s[n] * 1e9) if stamped else 0
        rate, force = truth.angular_rate_rad_s[n], truth.specific_force_m_s2[n]
        yield {
            "header": {"stamp": {"sec": ns // 10**9, "nanosec": ns % 10**9}, "frame_id": "imu"},
            "orientation": dict(zip("wxyz", map(float, q), strict=True)),
            "orientation_covariance": covariance if known else lost,
            "angular_velocity": dict(zip("xyz", map(float, rate), strict=True)),
            "angular_velocity_covariance": covariance,
            "linear_acceleration": dict(zip("xyz", map(float, force), strict=True)),
            "linear_acceleration_covariance": covariance,
        }


def write_mcap(path: Path, truth: Recording, topics: tuple[str, ...] = ("/imu",), **how) -> Path:  # type: ignore[no-untyped-def]
    with path.open("wb") as stream:
        writer = McapWriter(stream)
        schema = writer.register_msgdef(IMU, DEFINITION)
        text = writer.register_msgdef("std_msgs/msg/String", "string data")
        for n, message in enumerate(plain(truth, **how)):
            log_ns = START_NS + round(truth.time_s[n] * 1e9)
            writer.write_message("/chatter", text, {"data": "hello"}, log_time=log_ns)
            for topic in topics:
                writer.write_message(topic, schema, message, log_time=log_ns)
        writer.finish()
    return path


def write_bag(path: Path, truth: Recording, plugin: StoragePlugin | None) -> Path:
    store = get_typestore(Stores.ROS2_HUMBLE if plugin else Stores.ROS1_NOETIC)
    t = store.types
    vector, covariance = t["geometry_msgs/msg/Vector3"], np.zeros(9)
    bag = Bag2Writer(path, version=9, storage_plugin=plugin) if plugin else Bag1Writer(path)
    with bag:
        topic = bag.add_connection("/imu", IMU, typestore=store)
        for n, q in enumerate(attitude(truth)):
            ns = START_NS + round(truth.time_s[n] * 1e9)
            stamp = t["builtin_interfaces/msg/Time"](sec=ns // 10**9, nanosec=ns % 10**9)
            extra = {} if plugin else {"seq": n}
            w, x, y, z = q
            message = t[IMU](
                header=t["std_msgs/msg/Header"](stamp=stamp, frame_id="imu", **extra),
                orientation=t["geometry_msgs/msg/Quaternion"](x=x, y=y, z=z, w=w),
                orientation_covariance=covariance,
                angular_velocity=vector(*truth.angular_rate_rad_s[n]),
                angular_velocity_covariance=covariance,
                linear_acceleration=vector(*truth.specific_force_m_s2[n]),
                linear_acceleration_covariance=covariance,
            )
            raw = (
                store.serialize_cdr(message, IMU) if plugin else store.serialize_ros1(message, IMU)
            )
            bag.write(topic, ns, raw)
    return path


def same(got: Recording, truth: Recording) -> None:
    np.testing.assert_allclose(got.time_s, truth.time_s, atol=1e-9)
    np.testing.assert_array_equal(got.angular_rate_rad_s, truth.angular_rate_rad_s)
    np.testing.assert_array_equal(got.specific_force_m_s2, truth.specific_force_m_s2)
    np.testing.assert_allclose(got.up_reference, truth.up_reference, atol=1e-12)


def test_mcap(tmp_path: Path, truth, bring) -> None:
    imported = bring(write_mcap(tmp_path / "a.mcap", truth))
    assert imported.format == "mcap"
    same(imported.recording, truth)
    (said,) = imported.guessed
    assert said == "the reference is the orientation in /imu, an estimate of its sender"


def test_orientation_that_is_not_given_is_no_reference(tmp_path: Path, truth, bring) -> None:
    path = write_mcap(tmp_path / "a.mcap", truth, known=False)
    assert bring(path).recording.up_reference is None


def test_messages_without_stamps_take_the_time_of_recording(tmp_path: Path, truth, bring) -> None:
    imported = bring(write_mcap(tmp_path / "a.mcap", truth, stamped=False))
    same(imported.recording, truth)
    assert any("no time stamp" in said for said in imported.guessed)


def test_topics(tmp_path: Path, truth, bring) -> None:
    path = write_mcap(tmp_path / "a.mcap", truth, ("/imu/a", "/imu/b"))
    with pytest.raises(RecordingError, match=r"several topics.*: /imu/a, /imu/b; say --topic"):
        bring(path)
    same(bring(path, topic="/imu/b").recording, truth)
    with pytest.raises(RecordingError, match="no IMU topic /chatter"):
        bring(path, topic="/chatter")
    with pytest.raises(RecordingError, match="no topic of type"):
        bring(write_mcap(tmp_path / "b.mcap", truth, ()))


@pytest.mark.parametrize("kind", ["rosbag1", "sqlite", "mcap in a folder", "db3 alone"])
def test_rosbags(tmp_path: Path, truth, bring, kind: str) -> None:
    plugin = {"rosbag1": None, "mcap in a folder": StoragePlugin.MCAP}.get(
        kind, StoragePlugin.SQLITE3
    )
    path = write_bag(tmp_path / ("a.bag" if plugin is None else "a"), truth, plugin)
    if kind == "db3 alone":
        path = next(path.glob("*.db3"))
    imported = bring(path)
    assert imported.format == "rosbag"
    same(imported.recording, truth)


def test_unmeasured_force_is_refused() -> None:
    from hostkit.importers.ros_imu import ImuRows

    covariance = {"angular_velocity_covariance": [0.0], "linear_acceleration_covariance": [-1.0]}
    with pytest.raises(RecordingError, match="linear_acceleration is marked as not measured"):
        ImuRows().add(SimpleNamespace(**covariance), 0)


@pytest.mark.parametrize("kind", ["mcap", "rosbag1", "sqlite"])
@pytest.mark.parametrize("keep", [30, 3000, 30000])
def test_damaged_files_are_refused_in_one_line(
    tmp_path: Path, truth, bring, kind: str, keep: int
) -> None:
    if kind == "mcap":
        path = write_mcap(tmp_path / "a.mcap", truth)
    elif kind == "rosbag1":
        path = write_bag(tmp_path / "a.bag", truth, None)
    else:
        path = next(write_bag(tmp_path / "a", truth, StoragePlugin.SQLITE3).glob("*.db3"))
    path.write_bytes(path.read_bytes()[:keep])
    with pytest.raises(RecordingError) as caught:
        bring(path)
    assert "\n" not in str(caught.value)


def test_missing_library_is_named(tmp_path: Path, truth, bring, monkeypatch) -> None:
    path = write_mcap(tmp_path / "a.mcap", truth)
    monkeypatch.setitem(__import__("sys").modules, "mcap_ros2.decoder", None)
    from hostkit.errors import ToolMissingError

    with pytest.raises(ToolMissingError, match=r"pip install 'hostkit\[import\]'"):
        bring(path)
