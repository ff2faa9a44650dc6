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
INDUCTION = "orpos; bmc3 -F 3; ind -F 2"
"""First that the properties hold in so many clocks, which an induction of one less begins with."""

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
    """What yosys-abc found; `frame` is the clock of the counterexample, -1 if there is none.

    Induction that fails proves nothing, and has no counterexample.
    """

    proved: bool
    frame: int = -1


def prove(
    core: str,
    harness: str,
    folder: Path,
    parameters: Mapping[str, int] | None = None,
    *,
    free_products: bool = True,
    by_induction: bool = False,
) -> Verdict:
    """Decide on the properties of module ``properties`` in ``formal/HARNESS.v``.

    Parameters
    ----------
    core
        The converted Verilog.
    folder
        Where the tools work.
    parameters
        Parameters of the harness.
    free_products
        Whether every product, those of the harness too, is free.
    by_induction
        Only try whether all properties together hold in a clock because they did in the one
        before; for large counters, with which `pdr` comes to no end.
    """
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
    decide = INDUCTION if by_induction else "pdr"
    return read_verdict(_run(["yosys-abc", "-c", f"read_aiger model.aig; {decide}"], folder))


def read_verdict(said: str) -> Verdict:
    """Read the text: yosys-abc exits with 0 whatever it found."""
    refuted = re.search(r"was asserted in frame (\d+)", said)
    if refuted:
        return Verdict(proved=False, frame=int(refuted.group(1)))
    if "No output asserted in" in said and "Networks are UNDECIDED" in said:
        return Verdict(proved=False)
    by_induction = "No output asserted in" in said and "Networks are equivalent" in said
    assert "Property proved" in said or by_induction, said[-500:]
    return Verdict(proved=True)


def _run(command: list[str], folder: Path) -> str:
    done = subprocess.run(
        command, cwd=folder, capture_output=True, text=True, timeout=TIMEOUT_S, check=False
    )
    assert done.returncode == 0, f"{command[0]}: {(done.stderr or done.stdout)[-500:]}"
    return done.stdout
