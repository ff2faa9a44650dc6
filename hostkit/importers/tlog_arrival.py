"""A reference of another device on the link, whose clock is another one."""

from collections.abc import Mapping, Sequence

import numpy as np

from hostkit.importers.log import ReferenceTrack
from hostkit.importers.rotation import attitude_from_frd, from_euler
from hostkit.importers.timebase import seconds

Key = tuple[str, int, int]
"""Name of a message, system and component of its sender."""
Row = tuple[float, ...]


def arrived_attitude(
    streams: Mapping[Key, Sequence[Row]], delays: Mapping[Key, float], source: Key
) -> tuple[ReferenceTrack | None, str]:
    """Return the ATTITUDE of another system on the clock of the samples, and what to say of it.

    Two clocks are held against each other by the messages of each that took the shortest time to
    arrive.

    Parameters
    ----------
    streams
        Rows of each message: device time, us, then roll, pitch and yaw of an ATTITUDE, rad,
        forward-right-down.
    delays
        Least difference between the time of arrival and the device's, us.
    source
        Whose samples it is the reference of.
    """
    found = [key for key in streams if key[0] == "ATTITUDE" and key[1] != source[1]]
    if not found:
        return None, ""
    if len(found) > 1:
        systems = ", ".join(str(system) for _, system, _ in sorted(found))
        return None, f"ATTITUDE comes from systems {systems}: none is taken as the reference"
    values = np.array(streams[found[0]], dtype=np.float64)
    if len(values) < 2:
        return None, ""
    start = round(streams[source][0][0] + delays[source] - delays[found[0]])
    track_s = seconds(values[:, 0].astype(np.int64), 1e6, start)
    rising = np.concatenate([[True], track_s[1:] > np.maximum.accumulate(track_s)[:-1]])
    attitude = attitude_from_frd(from_euler(*values[rising, 1:4].T))
    said = (
        f"the reference is ATTITUDE of system {found[0][1]}; the two clocks are held against each "
        "other by times of arrival, to some milliseconds"
    )
    return ReferenceTrack(time_s=track_s[rising], quaternion_wxyz=attitude), said
