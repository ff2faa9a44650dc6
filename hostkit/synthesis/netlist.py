"""Runs converted Verilog or a mapped netlist in Icarus Verilog on a vector file."""

import re
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hostkit.emulation.tools import require
from hostkit.errors import BuildError, EmulationError
from hostkit.fixedpoint import wrap32
from hostkit.records import read_only
from hostkit.synthesis.process import run_tool

FOLDER = Path(__file__).parent
BENCH = FOLDER / "hk_gate_tb.v"
MEMORY = FOLDER / "ramb16bwer.v"
CELLS = "xilinx/cells_sim.v"
"""Models of the Xilinx cells, in the data folder of Yosys."""

COMPILE_TIMEOUT_S = 120.0
RUN_TIMEOUT_S = 900.0

_RESULT = re.compile(r"([0-9a-f]+) ((?:[0-9a-f]{8} ){4})([01]) ([01]) (\d+)")

IntArray = NDArray[np.int64]


@dataclass(frozen=True, slots=True, kw_only=True)
class GateRun:
    """What a converted or mapped core answered.

    Attributes
    ----------
    channel
        Shape ``(N,)``.
    state_raw
        Roll, pitch and their biases, shape ``(N, 4)``.
    restarted, saturated
        Shape ``(N,)``.
    latency_cycles
        Clocks from taking a sample to handing over its result, shape ``(N,)``.
    """

    design_digest: str
    channel: IntArray
    state_raw: IntArray
    restarted: NDArray[np.bool_]
    saturated: NDArray[np.bool_]
    latency_cycles: IntArray

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for array in (self.channel, self.state_raw, self.restarted, self.saturated):
            read_only(array)
        read_only(self.latency_cycles)


def play(
    verilog: str, vectors: IntArray, *, channels: int = 1, stalls: bool = False, mapped: bool = True
) -> GateRun:
    """Run a core of the entity ``hk_complementary_fixed``.

    Parameters
    ----------
    verilog
        A netlist of the family xc3sda, or converted Verilog.
    vectors
        Channel, accelerometer and gyroscope counts in sensor axes, shape ``(N, 7)``.
    channels
        What the core was converted with.
    stalls
        Offer samples and take results with gaps; inputs are unknown in the gaps.
    mapped
        Whether `verilog` consists of the cells of the family.

    Raises
    ------
    BuildError
        If Icarus Verilog refuses the Verilog, or Yosys' cells are missing.
    EmulationError
        If the simulation hangs, or writes an unknown value.
    ToolMissingError
        If Icarus Verilog is not installed.
    """
    require("iverilog")
    bits = max(1, (channels - 1).bit_length())
    with tempfile.TemporaryDirectory(prefix="hostkit-gates-") as name:
        build = Path(name)
        (build / "core.v").write_text(verilog, encoding="utf-8")
        words = (vectors & 0xFFFF).tolist()
        text = "".join(" ".join(f"{word:04x}" for word in row) + "\n" for row in words)
        (build / "vectors.txt").write_text(text, encoding="ascii")
        cells = [str(cells_file()), str(MEMORY)] if mapped else []
        options = [f"-Phk_gate_tb.CHANNEL_BITS={bits}", f"-Phk_gate_tb.STALLS={int(stalls)}"]
        command = ["iverilog", "-g2012", *options, "-s", "hk_gate_tb", "-o", "bench"]
        run_tool([*command, str(BENCH), "core.v", *cells], build, timeout_s=COMPILE_TIMEOUT_S)
        said = run_tool(["vvp", "-n", "bench"], build, timeout_s=RUN_TIMEOUT_S)
        return _parsed((build / "results.txt").read_text("ascii"), said, len(vectors))


def cells_file() -> Path:
    """Return the file with Yosys' models of the Xilinx cells.

    Raises
    ------
    BuildError
        If it is not where Yosys keeps its data.
    ToolMissingError
        If Yosys is not installed.
    """
    require("yosys")
    with tempfile.TemporaryDirectory(prefix="hostkit-cells-") as name:
        copy = Path(name) / "cells.txt"
        script = f"tee -q -o {copy} read_verilog -lib +/{CELLS}"
        run_tool(["yosys", "-p", script], Path(name), timeout_s=COMPILE_TIMEOUT_S)
        found = re.search(r"frontend: (/\S+)", copy.read_text(encoding="utf-8"))
    if found is None or not Path(found.group(1)).is_file():
        raise BuildError(f"yosys has no {CELLS}")
    return Path(found.group(1))


def _parsed(results: str, said: str, samples: int) -> GateRun:
    lines = results.splitlines()
    if lines[-1:] != ["end"]:
        raise EmulationError(f"the simulation did not come to its end: {said.strip()[:200]}")
    digest, *rows = lines[:-1]
    if len(rows) != samples:
        raise EmulationError(f"the simulation wrote {len(rows)} results for {samples} samples")
    values = np.array([_parsed_row(row) for row in rows], dtype=np.int64).reshape(-1, 8)
    return GateRun(
        design_digest=digest,
        channel=values[:, 0].copy(),
        state_raw=wrap32(values[:, 1:5]),
        restarted=values[:, 5] == 1,
        saturated=values[:, 6] == 1,
        latency_cycles=values[:, 7].copy(),
    )


def _parsed_row(row: str) -> tuple[int, ...]:
    match = _RESULT.fullmatch(row)
    if match is None:
        raise EmulationError(f"the simulation wrote {row[:60]!r}, which is not a result")
    channel, words, restarted, saturated, latency = match.groups()
    states = [int(word, 16) for word in words.split()]
    return (int(channel, 16), *states, int(restarted), int(saturated), int(latency))
