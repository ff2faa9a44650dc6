"""The serial line of a cocotb bench: every byte that comes, and bytes that are sent."""

from cocotb.triggers import FallingEdge, Timer


class Listener:
    """Collects the bytes of a line from its idle state on."""

    def __init__(self, line, baud: int) -> None:
        self.line = line
        self.bit_ps = round(1e12 / baud)
        self.heard = bytearray()

    async def run(self) -> None:
        while True:
            await FallingEdge(self.line)
            await Timer(self.bit_ps // 2, "ps")
            assert self.line.value == 0, "a start bit is too short"
            value = 0
            for i in range(8):
                await Timer(self.bit_ps, "ps")
                value |= int(self.line.value) << i
            await Timer(self.bit_ps, "ps")
            assert self.line.value == 1, "a stop bit is missing"
            self.heard.append(value)


async def send(line, baud: int, value: int) -> None:
    """Send one byte."""
    for bit in (0, *((value >> i) & 1 for i in range(8)), 1):
        line.value = bit
        await Timer(round(1e12 / baud), "ps")
