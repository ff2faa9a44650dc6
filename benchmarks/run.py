"""Prints the benchmarks: ``python benchmarks/run.py [NAME...]``; all of them without a name."""

import importlib
import sys
import time

from hostkit.cli.inputs import say
from hostkit.errors import HostkitError

BENCHES = (
    "kernel",
    "tuning",
    "rules",
    "several",
    "functions",
    "correlation",
    "device",
    "fpga",
    "accuracy",
    "accuracy_choice",
    "observer_cost",
    "large",
    "decode",
    "monitor",
)
"""Modules of this folder; each has a function `tables`."""


def main(names: list[str]) -> int:
    """Print the tables of some benchmarks, or of all."""
    unknown = sorted(set(names) - set(BENCHES))
    if unknown:
        say(f"no benchmark {', '.join(unknown)}; there are: {', '.join(BENCHES)}")
        return 2
    return max([_print(name) for name in names or BENCHES])


def _print(name: str) -> int:
    """Print the tables of one benchmark; what it lacks is said, and the next one goes on."""
    begun = time.perf_counter()
    try:
        for table in importlib.import_module(f"benchmarks.{name}").tables():
            print(table.text(), end="\n\n", flush=True)
    except HostkitError as error:
        say(f"{name}: {error}")
        return error.exit_code
    say(f"{name}: {time.perf_counter() - begun:.0f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
