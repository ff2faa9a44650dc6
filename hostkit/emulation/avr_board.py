"""The ATmega328P target: the image on the CPU emulator avr8js, the virtual sensor on its bus."""

from hostkit.emulation.node_board import NodeBoard

BOARD = NodeBoard(emulator="avr8js", toolchain="avr-", image="firmware.hex")

build = BOARD.build
run = BOARD.run
serve = BOARD.serve
