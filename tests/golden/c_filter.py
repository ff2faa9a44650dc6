"""The C filter of a folder as a program: counts in, state out."""

from pathlib import Path

import numpy as np

SOURCES = ("hk_filter.c", "hk_filter_settings.c", "hk_arctan.c", "hk_units.c", "hk_fixed.c")


def filter_sources(code: Path) -> tuple[Path, ...]:
    """Return the C files of the filter."""
    return tuple(code / name for name in SOURCES if (code / name).exists())


def c_response(host_cc, code: Path, counts: np.ndarray, output: Path) -> np.ndarray:
    """Roll, pitch, restarted and hidden words, two at least; built strictly and with sanitizers."""
    harness = Path(__file__).with_name("vector_main.c")
    program = host_cc.build(output, f"-I{code}", harness, *filter_sources(code))
    return np.array(host_cc.run(program, counts), dtype=np.int64)
