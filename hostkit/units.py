"""Unit conversions used at the edges: sensors, file headers and the screen."""

import math

STANDARD_GRAVITY_M_S2 = 9.80665
"""Standard acceleration of gravity (CGPM 1901)."""

RAD_PER_DEG = math.pi / 180.0
DEG_PER_RAD = 180.0 / math.pi

HALF_TURN_BITS = 31
RAD_PER_HALF_TURN_LSB = math.pi / 2**HALF_TURN_BITS
"""Weight of one count of a signed 32-bit angle, whose overflow is the wrap at +-pi."""
