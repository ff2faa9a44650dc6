"""Recordings: reading, checking and writing what a sensor measured."""

from hostkit.recordings.recording import Recording
from hostkit.recordings.sanity import Finding, SanityCard, check, require_sound
from hostkit.recordings.store import SUFFIXES, load, require_suffix, save

__all__ = [
    "SUFFIXES",
    "Finding",
    "Recording",
    "SanityCard",
    "check",
    "load",
    "require_sound",
    "require_suffix",
    "save",
]
