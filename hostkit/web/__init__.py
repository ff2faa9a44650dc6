"""The page of the monitor: a server on this machine, and what it serves."""
