"""Text that came over a link, made fit for a page and for XML."""

import unicodedata

REPLACEMENT = "\N{REPLACEMENT CHARACTER}"


def plain_text(text: str, most: int = 500) -> str:
    """Return a text whose characters can all be seen, cut to so many.

    Characters that control, that turn the direction of writing or that are none at all are
    replaced: XML does not allow some of them, and others make a text look like another.
    """
    shown = "".join(c if c == " " or c.isprintable() else _shown(c) for c in text[:most])
    return shown if len(text) <= most else shown + "..."


def _shown(character: str) -> str:
    return " " if unicodedata.category(character) == "Zs" or character in "\t\n\r" else REPLACEMENT
