"""The C filter of a folder as a program: counts in, state out."""

from pathlib import Path

import numpy as np


def c_response(host_cc, code: Path, counts: np.ndarray, output: Path) -> np.ndarray:
    """Roll, pitch, restarted and two hidden words; built strictly and with sanitizers."""
    harness = Path(__file__).with_name("vector_main.c")
    sources = (harness, code / "hk_filter.c", code / "hk_arctan.c")
    program = host_cc.build(output, f"-I{code}", *sources)
    return np.array(host_cc.run(program, counts), dtype=np.int64)
