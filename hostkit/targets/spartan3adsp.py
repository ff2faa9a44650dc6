"""The Xilinx Spartan-3A DSP (XC3SD3400A): the filter as a VHDL-93 core and its test bench."""

from hostkit.targets.target import Target

SPARTAN3ADSP = Target(
    name="spartan3adsp",
    title="Spartan-3A DSP (XC3SD3400A), VHDL-93",
    kind="fpga",
    folders=("common", "polar", "sensor", "link", "registers", "system", "spartan3adsp", "sim"),
)
