"""Generated VHDL made into gates: converted, mapped, counted, simulated and placed."""
