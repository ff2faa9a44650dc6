"""Talking with a device: parameters, commands, who is there."""
