"""Logs of frames: tlog files, written, indexed and replayed."""
