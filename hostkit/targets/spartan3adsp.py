"""The Xilinx Spartan-3A DSP (XC3SD3400A): the system in VHDL-93, and a project for ISE.

Pins of the 1800A board are those of GRLIB's ``boards/xilinx-spa3-dsp1800a/leon3mp.ucf``. No
public file that names the pins of the 3400A board was found, so they are left to the user.
"""

from hostkit.targets.board import Board, Part, Pin
from hostkit.targets.clocking import ClockMaker
from hostkit.targets.target import Target

DCM = ClockMaker(
    title="DCM_SP (CLKFX)",
    input_hz=(200_000, 333_000_000),
    output_hz=(5_000_000, 250_000_000),
    multiply=(2, 32),
    divide=(1, 32),
)
"""Spartan-3A DSP, speed grade -4. The DCM makes more than 250 MHz; multipliers and block RAM do
not take it (DS610)."""

PLATFORM_3400A = Board(
    name="xc3sd3400a",
    title="XtremeDSP Development Platform, Spartan-3A DSP 3400A Edition (UG498)",
    part=Part(device="xc3sd3400a", package="fg676", speed="-4"),
    oscillator_hz=125_000_000,
    pins=(
        Pin(port="clk_in", site="", note="oscillator, a pin with global clock buffer"),
        Pin(port="reset_button", site="", note="push button, high when pressed"),
        Pin(port="scl", site="", note="header; external pull-up of 2.2 to 4.7 kohm to 3.3 V"),
        Pin(port="sda", site="", note="header; external pull-up of 2.2 to 4.7 kohm to 3.3 V"),
        Pin(port="int_pin", site="", note="header; INT of the sensor"),
        Pin(port="uart_rx", site="", note="from the RS-232 transceiver"),
        Pin(port="uart_tx", site="", note="to the RS-232 transceiver"),
        Pin(port="led_running", site="", note="LED"),
        Pin(port="led_failed", site="", note="LED"),
    ),
)

STARTER_1800A = Board(
    name="xc3sd1800a",
    title="Spartan-3A DSP Starter Platform, 1800A Edition (UG454)",
    part=Part(device="xc3sd1800a", package="fg676", speed="-4"),
    oscillator_hz=125_000_000,
    pins=(
        Pin(port="clk_in", site="F13", note="125 MHz oscillator"),
        Pin(port="reset_button", site="J17", note="push button SW5, high when pressed"),
        Pin(port="scl", site="", note="header; external pull-up of 2.2 to 4.7 kohm to 3.3 V"),
        Pin(port="sda", site="", note="header; external pull-up of 2.2 to 4.7 kohm to 3.3 V"),
        Pin(port="int_pin", site="", note="header; INT of the sensor"),
        Pin(port="uart_rx", site="N21", note="from the RS-232 transceiver"),
        Pin(port="uart_tx", site="P22", note="to the RS-232 transceiver"),
        Pin(port="led_running", site="P18", note="LED"),
        Pin(port="led_failed", site="P25", note="LED"),
    ),
    source="GRLIB, boards/xilinx-spa3-dsp1800a/leon3mp.ucf",
)

SPARTAN3ADSP = Target(
    name="spartan3adsp",
    title="Spartan-3A DSP (XC3SD3400A), VHDL-93",
    kind="fpga",
    folders=(
        *("common", "sensor", "link"),
        *("registers", "system", "report", "spartan3adsp", "sim"),
    ),
    clock_hz=50_000_000,
    boards=(PLATFORM_3400A, STARTER_1800A),
    clock_maker=DCM,
    family="xc3sda",
)
