"""The driver alone, built with sanitizers against the virtual sensor: see driver_bench.c."""

import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from boards import changed

from hostkit.emulation.board import Stimulus
from hostkit.emulation.fault import KINDS
from hostkit.records import FilterDesign
from hostkit.render import FirmwareOptions, generate, write
from hostkit.targets import TARGETS

LOSING = "    push_sample(sensor, burst);\n    (void)hk_virtual_fifo_pop(sensor);\n"
ERRORS = (
    "transfer",
    "torn",
    "dead bus",
    "register",
    "self reset",
    "lost ready",
    "silent",
    "frozen",
    "variant",
    "overflow",
    "misaligned",
)
STRICT = ("-std=c99", "-Wall", "-Wextra", "-Wconversion", "-Werror", "-ffp-contract=off")
CHECKS = ("-O1", "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all")


def build(folder: Path, code: FilterDesign, *, fifo: bool, losing: bool = False) -> Path:
    """Build for a design, with a link that is fast enough for any rate.

    With `losing` the virtual sensor's FIFO loses a byte of every sample.
    """
    options = FirmwareOptions(acquisition="fifo" if fifo else "burst", baud=2_000_000)
    write(generate(code, TARGETS["host"], options), folder)
    if losing:
        model = folder / "hk_virtual_fifo.c"
        changed(model, "    push_sample(sensor, burst);\n    for", LOSING + "    for")
    parts = ("hk_mpu6050*.c", "hk_self_test.c", "hk_virtual_*.c")
    sources = sorted(str(file) for part in parts for file in folder.glob(part))
    harness = Path(__file__).with_name("driver_bench.c")
    command = ["gcc", *STRICT, *CHECKS, f"-I{folder}", "-o", str(folder / "bench"), *sources]
    done = subprocess.run([*command, str(harness)], capture_output=True, text=True, timeout=100)
    assert done.returncode == 0, done.stderr
    return folder / "bench"


@dataclass(frozen=True)
class Report:
    """What the driver said."""

    samples: np.ndarray  # columns: accel x, y, z, temperature, gyro x, y, z
    time_us: np.ndarray
    after_gap: np.ndarray
    starts: int
    tested: list[list[int]]
    refused: list[int]
    errors: dict[str, int]  # those that are not 0
    lost: int


def code_of(name: str) -> int:
    return next(kind.code for kind in KINDS if kind.name == name)


def fault(name: str, amount: int = 0) -> str:
    return f"fault {code_of(name)} {amount}"


def at_once(name: str, amount: int = 0) -> str:
    return f"at-once {code_of(name)} {amount}"


def run(program: Path, feels: Stimulus, *commands: str) -> Report:
    table = program.with_name("table.bin")
    table.write_bytes(feels.table())
    done = subprocess.run(
        [str(program), str(table)],
        input="\n".join(commands) + "\n",
        capture_output=True,
        text=True,
        timeout=100,
    )
    assert done.returncode == 0, done.stderr
    said = [line.split() for line in done.stdout.splitlines()]
    numbers = {
        verb: [[int(n) for n in rest] for v, *rest in said if v == verb] for verb, *_ in said
    }
    samples = np.array(numbers.get("sample", []), dtype=np.int64).reshape(-1, 9)
    counts = numbers["counts"][0]
    assert len(counts) == len(ERRORS)
    return Report(
        samples=samples[:, 2:],
        time_us=samples[:, 0],
        after_gap=samples[:, 1].astype(bool),
        starts=len(numbers.get("started", [])),
        tested=numbers.get("tested", []),
        refused=[r[0] for r in numbers.get("refused", [])],
        errors={name: n for name, n in zip(ERRORS, counts, strict=True) if n},
        lost=numbers["lost"][0][0],
    )
