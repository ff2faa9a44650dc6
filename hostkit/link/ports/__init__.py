"""Ports and what reads them: serial, pseudo-terminal, TCP, UDP."""
