"""Numbers as text of C."""

import numpy as np


def float32_text(value: float) -> str:
    """Return the nearest number of 32 bits as C99 hexadecimal text, without suffix."""
    return float(np.float32(value)).hex()
