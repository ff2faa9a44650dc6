"""Boards with an FPGA: which part, which oscillator, which signal on which pin."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """An FPGA as its vendor orders it."""

    device: str
    package: str
    speed: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Pin:
    """A port of the top and where it is on a board.

    Attributes
    ----------
    site
        Pin of the package; empty where no public source names it and the user has to.
    note
        What it is on the board, or what to look for.
    """

    port: str
    site: str
    note: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Board:
    """A board.

    Attributes
    ----------
    oscillator_hz
        Clock on the pin of ``clk_in``.
    source
        Where the pins are known from; empty where they are not.
    """

    name: str
    title: str
    part: Part
    oscillator_hz: int
    pins: tuple[Pin, ...]
    source: str = ""
