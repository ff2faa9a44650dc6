"""What platformio.ini cannot say of linking: only our start-up code, and the small C library."""

from SCons.Script import DefaultEnvironment

env = DefaultEnvironment()
env.Append(LINKFLAGS=["-nostartfiles", "--specs=nano.specs", "-Wl,--gc-sections"])
