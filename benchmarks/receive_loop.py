"""The peer of the monitor: pymavlink's own loop. Prints messages received and lost.

Nothing is judged, counted or kept.
"""

import os
import sys
import time

os.environ["MAVLINK20"] = "1"

from pymavlink import mavutil

from hostkit.dialect import python_module


def main(port: str, duration_s: float) -> int:
    """Receive for a while."""
    own = python_module().MAVLink_tilt_sample_message
    mavutil.mavlink.mavlink_map[own.id] = own
    link = mavutil.mavlink_connection(port, baud=4_000_000)
    received, end = 0, None
    while end is None or time.monotonic() < end:
        if link.recv_match(blocking=True, timeout=1.0) is not None:
            received += 1
            end = end or time.monotonic() + duration_s
            if received == 1:
                print("first", flush=True)
    print(received, link.mav_loss, flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], float(sys.argv[2])))
