"""The Lattice ECP5 on a ULX3S: the system, built by open tools to a bitstream.

Pins are those of emard/ulx3s, ``doc/constraints/ulx3s_v20.lpf``.
"""

from hostkit.targets.board import Board, Part, Pin
from hostkit.targets.clocking import ClockMaker
from hostkit.targets.target import Target

PLL = ClockMaker(
    title="EHXPLLL",
    input_hz=(8_000_000, 400_000_000),
    output_hz=(5_000_000, 250_000_000),
    multiply=(1, 80),
    divide=(1, 128),
    detector_hz=(10_000_000, 400_000_000),
    oscillator_hz=(400_000_000, 800_000_000),
    output_divide=128,
)

ULX3S = Board(
    name="ulx3s",
    title="ULX3S v2.x and v3.0.x",
    part=Part(device="25k", package="CABGA381"),
    oscillator_hz=25_000_000,
    pins=(
        Pin(port="clk_in", site="G2", note="25 MHz oscillator"),
        Pin(port="reset_button", site="R1", note="FIRE1, high when pressed"),
        Pin(port="scl", site="B11", note="J1 5+, GP0"),
        Pin(port="sda", site="C11", note="J1 5-, GN0"),
        Pin(port="int_pin", site="A10", note="J1 7+, GP1"),
        Pin(port="uart_rx", site="M1", note="from the FTDI"),
        Pin(port="uart_tx", site="L4", note="to the FTDI"),
        Pin(port="led_running", site="B2", note="LED 0"),
        Pin(port="led_failed", site="C2", note="LED 1"),
        Pin(port="wifi_gpio0", site="L2", note="high, so that the ESP32 does not take over"),
    ),
    source="emard/ulx3s, doc/constraints/ulx3s_v20.lpf",
)

ECP5 = Target(
    name="ecp5",
    title="ECP5 (LFE5U-25F, ULX3S), VHDL-93",
    kind="fpga",
    folders=(
        *("common", "sensor", "link"),
        *("registers", "system", "report", "ecp5", "sim"),
    ),
    clock_hz=25_000_000,
    boards=(ULX3S,),
    clock_maker=PLL,
    family="ecp5",
)
