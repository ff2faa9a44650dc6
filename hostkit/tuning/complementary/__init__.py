"""The tuning of the complementary filter."""

from hostkit.tuning.complementary.tuner import COMPLEMENTARY_TUNER, tuning_problem

__all__ = ["COMPLEMENTARY_TUNER", "tuning_problem"]
