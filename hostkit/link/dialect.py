from hostkit.dialect import *  # noqa
