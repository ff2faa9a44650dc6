"""Runs a command and prints how long it took, s, its peak memory, bytes, and its exit code.

A process of its own, and a small one: a child's peak begins with that of the process it was started
from.
"""

import os
import subprocess
import sys
import time

BYTES_PER_UNIT = 1 if sys.platform == "darwin" else 1024
"""Of ``ru_maxrss``."""


def main(command: list[str]) -> int:
    """Run a command."""
    begun = time.perf_counter()
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    spent = time.perf_counter() - begun
    code = os.waitstatus_to_exitcode(status)
    print(f"{spent:.6f} {usage.ru_maxrss * BYTES_PER_UNIT} {code}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
