"""Loading built firmware into a board, by the programs that others wrote for it."""

from hostkit.flashing.loading import FlashPlan, flash, plan_flash
from hostkit.flashing.programmer import PROGRAMMERS

__all__ = ["PROGRAMMERS", "FlashPlan", "flash", "plan_flash"]
