"""Recordings: reading, checking and writing what a sensor measured."""

from hostkit.recordings.large import LargeRecording, open_large
from hostkit.recordings.recording import Recording
from hostkit.recordings.sanity import Finding, SanityCard, check, require_sound
from hostkit.recordings.store import SUFFIXES, load, require_suffix, save

__all__ = [
    "SUFFIXES",
    "Finding",
    "LargeRecording",
    "Recording",
    "SanityCard",
    "check",
    "load",
    "open_large",
    "require_sound",
    "require_suffix",
    "save",
]
