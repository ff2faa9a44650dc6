"""The filters that can be tuned."""

from hostkit.registry import Registry
from hostkit.tuning.complementary import COMPLEMENTARY_TUNER
from hostkit.tuning.observer import OBSERVER_TUNER
from hostkit.tuning.tuner import Tuner

TUNERS: Registry[Tuner] = Registry("tuner", (COMPLEMENTARY_TUNER, OBSERVER_TUNER))
