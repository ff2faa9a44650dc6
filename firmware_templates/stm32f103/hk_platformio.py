"""What platformio.ini cannot say of linking: no start-up files but ours, and the small C library."""

from SCons.Script import DefaultEnvironment

env = DefaultEnvironment()
env.Append(LINKFLAGS=["-nostartfiles", "--specs=nano.specs", "-Wl,--gc-sections"])
