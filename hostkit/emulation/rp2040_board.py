"""The RP2040 target: the image on the CPU emulator rp2040js, the virtual sensor on its bus.

A program in the generated folder makes the UF2 file, hence a compiler of the host for the build.
"""

from hostkit.emulation.node_board import NodeBoard

BOARD = NodeBoard(
    emulator="rp2040js",
    toolchain="arm-none-eabi-",
    image="firmware.uf2",
    build_tools=("gcc",),
)

build = BOARD.build
run = BOARD.run
serve = BOARD.serve
