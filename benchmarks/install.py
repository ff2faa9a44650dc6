"""Installs the peers one by one, where they cannot all be: ``python -m benchmarks.install``."""

import subprocess
import sys
from importlib.metadata import requires

from hostkit.cli.inputs import say

QUIET = ("--quiet", "--disable-pip-version-check")


def peers(requirements: list[str]) -> tuple[str, ...]:
    """Return what the extra `bench` asks for, without the conditions."""
    split = [one.partition(";") for one in requirements]
    return tuple(
        name.strip()
        for name, _, condition in split
        if "bench" in condition.partition("extra")[2].strip(" ='\"")
    )


def main() -> int:
    """Install every peer that can be; the others are shown as missing."""
    for peer in peers(requires("hostkit") or []):
        command = (sys.executable, "-m", "pip", "install", *QUIET, peer)
        if subprocess.run(command, check=False, stderr=subprocess.DEVNULL).returncode:
            say(f"{peer} cannot be installed here; its figures will be missing")
    return 0


if __name__ == "__main__":
    sys.exit(main())
