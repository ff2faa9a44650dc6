"""Proves properties of converted Verilog: Yosys makes an AIGER model, yosys-abc decides on it.

A model begins in any state and is reset in its first clock. Inputs that a harness leaves open, and
all products, are free in every clock; so what is proved holds for any product.
"""

import re
import subprocess
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

FOLDER = Path(__file__).parent
CHECKER = FOLDER / "stream_checker.v"
TIMEOUT_S = 300.0

TO_AIGER = """
setundef -undriven -anyseq
opt -full
async2sync
formalff -clk2ff -ff2anyinit
opt_clean
chformal -cover -remove
dffunmap
opt -full
techmap
abc -g AND -fast
opt_clean
write_aiger -zinit model.aig
"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """What yosys-abc found; `frame` is the clock of the counterexample, -1 if there is none."""

    proved: bool
    frame: int = -1


def prove(
    core: str,
    harness: str,
    folder: Path,
    parameters: Mapping[str, int] | None = None,
    *,
    free_products: bool = True,
) -> Verdict:
    """Decide on the properties of module ``properties`` in ``formal/HARNESS.v``."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "core.v").write_text(core, encoding="utf-8")
    chosen = "".join(f" -chparam {name} {value}" for name, value in (parameters or {}).items())
    script = (
        f"read_verilog core.v\nread_verilog -formal {CHECKER} {FOLDER / harness}.v\n"
        f"hierarchy -top properties{chosen}\nprep -flatten -top properties\nmemory_map\n"
        + ("delete t:$mul\n" if free_products else "")
        + TO_AIGER
    )
    (folder / "model.ys").write_text(script, encoding="utf-8")
    _run(["yosys", "-q", "model.ys"], folder)
    return read_verdict(_run(["yosys-abc", "-c", "read_aiger model.aig; pdr"], folder))


def read_verdict(said: str) -> Verdict:
    """Read the text: yosys-abc exits with 0 whatever it found."""
    refuted = re.search(r"was asserted in frame (\d+)", said)
    if refuted:
        return Verdict(proved=False, frame=int(refuted.group(1)))
    assert "Property proved" in said, said[-500:]
    return Verdict(proved=True)


def _run(command: list[str], folder: Path) -> str:
    done = subprocess.run(
        command, cwd=folder, capture_output=True, text=True, timeout=TIMEOUT_S, check=False
    )
    assert done.returncode == 0, f"{command[0]}: {(done.stderr or done.stdout)[-500:]}"
    return done.stdout
