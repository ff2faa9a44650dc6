"""Runs converted Verilog or a mapped netlist in Icarus Verilog on a vector file."""

import re
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hostkit.emulation.tools import require
from hostkit.errors import BuildError, EmulationError
from hostkit.filters import FILTERS
from hostkit.fixedpoint import wrap32
from hostkit.records import read_only
from hostkit.spec import FixedPointSpec
from hostkit.synthesis.process import run_tool

FOLDER = Path(__file__).parent
BENCH = FOLDER / "hk_gate_tb.v"
MEMORY = FOLDER / "ramb16bwer.v"
CELLS = "xilinx/cells_sim.v"
"""Models of the Xilinx cells, in the data folder of Yosys."""

COMPILE_TIMEOUT_S = 120.0
RUN_TIMEOUT_S = 900.0

_RESULT = re.compile(r"([0-9a-f]+) ((?:[0-9a-f]{8} ){2,})([01]) ([01]) (\d+)")

IntArray = NDArray[np.int64]


@dataclass(frozen=True, slots=True, kw_only=True)
class GateRun:
    """What a converted or mapped core answered.

    Attributes
    ----------
    channel
        Shape ``(N,)``.
    state_raw
        Roll, pitch and the hidden words that the core shows, shape ``(N, 2 + H)``.
    restarted, saturated
        Shape ``(N,)``.
    latency_cycles
        Clocks from taking a sample to offering its result, shape ``(N,)``.
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
    verilog: str,
    vectors: IntArray,
    spec: FixedPointSpec,
    *,
    channels: int = 1,
    stalls: bool = False,
    mapped: bool = True,
) -> GateRun:
    """Run the core of a filter: its entity with the settings of the design inside.

    Parameters
    ----------
    verilog
        A netlist of the family xc3sda, or converted Verilog.
    vectors
        Channel, accelerometer and gyroscope counts in sensor axes, shape ``(N, 7)``.
    spec
        The design of the core; it says which entity and which ports it has.
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
        command = ["iverilog", "-g2012", *options, *_ports(spec), "-s", "hk_gate_tb", "-o", "bench"]
        run_tool([*command, str(BENCH), "core.v", *cells], build, timeout_s=COMPILE_TIMEOUT_S)
        said = run_tool(["vvp", "-n", "bench"], build, timeout_s=RUN_TIMEOUT_S)
        return _parsed((build / "results.txt").read_text("ascii"), said, len(vectors))


def _ports(spec: FixedPointSpec) -> tuple[str, ...]:
    """Return what the bench has to know of the core, as options of Icarus Verilog."""
    core = f"-DCORE=hk_{spec.filter}_fixed"
    if spec.tells_state:
        return (core, f"-DSTATE_WORDS={len(spec.hidden)}")
    own = FILTERS[spec.filter].core
    ports = () if own is None else own.facts(spec, False).hidden_ports
    parts = (f".{port.name}(hidden[{32 * i} +: 32])," for i, port in enumerate(ports))
    return (core, f"-DHIDDEN_WORDS={len(ports)}", f"-DHIDDEN_PORTS={' '.join(parts)}")


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
    values = np.array([_parsed_row(row) for row in rows], dtype=np.int64)
    return GateRun(
        design_digest=digest,
        channel=values[:, 0].copy(),
        state_raw=wrap32(values[:, 1:-3]),
        restarted=values[:, -3] == 1,
        saturated=values[:, -2] == 1,
        latency_cycles=values[:, -1].copy(),
    )


def _parsed_row(row: str) -> tuple[int, ...]:
    match = _RESULT.fullmatch(row)
    if match is None:
        raise EmulationError(f"the simulation wrote {row[:60]!r}, which is not a result")
    channel, words, restarted, saturated, latency = match.groups()
    states = [int(word, 16) for word in words.split()]
    return (int(channel, 16), *states, int(restarted), int(saturated), int(latency))
