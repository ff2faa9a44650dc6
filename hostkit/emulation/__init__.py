"""Emulation: boards that run the built firmware, the simulated core, the virtual sensor."""
