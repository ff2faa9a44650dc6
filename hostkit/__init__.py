"""hostkit: tune a tilt filter, render it to C and VHDL, prove the device equals the model."""

__version__ = "0.1.0"
