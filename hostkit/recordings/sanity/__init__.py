"""Sanity of a recording: hard faults that refuse it, and findings that deserve a second look."""

from hostkit.recordings.sanity.card import SanityCard, check
from hostkit.recordings.sanity.findings import Finding, Kind
from hostkit.recordings.sanity.soundness import require_sound

__all__ = ["Finding", "Kind", "SanityCard", "check", "require_sound"]
