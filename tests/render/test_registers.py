import re
import shutil
import subprocess
from pathlib import Path

import pytest
from designs import all_parameters, design

from hostkit.errors import FormatError, RenderError
from hostkit.filters import FILTERS
from hostkit.filters.complementary import settings
from hostkit.records import FilterDesign
from hostkit.render import render_target
from hostkit.render.fpga_options import FpgaOptions
from hostkit.render.registers import Field, Register, RegisterMap, register_map
from hostkit.render.registers.values import setting_value, setting_word
from hostkit.spec import FixedPointSpec
from hostkit.targets import TARGETS
from hostkit.units import STANDARD_GRAVITY_M_S2

DESIGNS = {
    "all": all_parameters(),
    "plain": design(),
    "pitch": design(axes="pitch", tilt="arcsin", rate_hz=1000.0, gyro_full_scale_deg_s=2000),
}
OPTIONS = FpgaOptions(bus="axi4lite", channels=4, pipelined=True)


def lower(source: FilterDesign) -> FixedPointSpec:
    return FILTERS["complementary"].lower(source)


def the_map(source: FilterDesign) -> RegisterMap:
    return register_map(source, lower(source), OPTIONS)


@pytest.fixture(params=DESIGNS.values(), ids=DESIGNS)
def source(request: pytest.FixtureRequest) -> FilterDesign:
    return request.param


def rendered(source: FilterDesign, name: str) -> str:
    files = render_target(source, TARGETS["spartan3adsp"], OPTIONS)
    return next(file.content for file in files if file.path == name)


def field(**changes: object) -> Field:
    own = {"name": "SPEED", "description": "", "low": 0, "width": 8, "element": "speed"}
    return Field(**(own | changes))


def register(*fields: Field, **changes: object) -> Register:
    own = {"name": "MOTOR", "description": "", "address": 0, "fields": fields or (field(),)}
    return Register(**(own | changes))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"name": "signal"}, "reserved word of VHDL-93"),
        ({"name": "reg"}, "reserved word of Verilog-2001 and SystemRDL"),
        ({"name": "Volatile"}, "reserved word of C99"),
        ({"name": "SPEED_"}, "no identifier"),
        ({"element": "wire"}, "reserved word of Verilog-2001"),
        ({"element": ""}, "has no element"),
        ({"source": "constant"}, "has no element"),
        ({"access": "wo"}, "access = 'wo'"),
        ({"kind": "float"}, "kind = 'float'"),
        ({"source": "air"}, "source = 'air'"),
        ({"low": 25}, "bits 32 to 25"),
        ({"low": -1}, "bits 6 to -1"),
        ({"width": 0}, "bits -1 to 0"),
        ({"reset": 256}, "does not fit 8 bits"),
        ({"reset": -1}, "does not fit 8 bits"),
        ({"reset": 1, "present": False}, "must be 0"),
    ],
)
def test_a_field_that_cannot_be_is_refused(changes: dict[str, object], message: str) -> None:
    with pytest.raises(RenderError, match=re.escape(message)):
        field(**changes)


def test_a_register_that_cannot_be_is_refused() -> None:
    for changes, message in (
        ({"name": "begin"}, "reserved word"),
        ({"address": 2}, "multiple of 4"),
        ({"address": 256}, "below 256"),
    ):
        with pytest.raises(RenderError, match=message):
            register(**changes)
    with pytest.raises(RenderError, match="no fields"):
        register(fields=())
    with pytest.raises(RenderError, match="must start above bit 7"):
        register(field(), field(name="TORQUE", low=7))
    with pytest.raises(RenderError, match="there twice"):
        register(field(), field(name="Speed", low=8))


def test_a_map_that_cannot_be_is_refused() -> None:
    with pytest.raises(RenderError, match="there twice"):
        RegisterMap(registers=(register(), register(name="motor", address=4)))
    with pytest.raises(RenderError, match="must lie above"):
        RegisterMap(registers=(register(), register(name="PUMP")))
    with pytest.raises(RenderError, match="no register 'PUMP'"):
        RegisterMap(registers=(register(),)).register("PUMP")


def test_the_constants_tell_the_design(source: FilterDesign) -> None:
    registers = the_map(source)

    def constant(register: str, field: str) -> int:
        fields = registers.register(register).fields
        return next(f.reset for f in fields if f.name == field)

    spec = lower(source)
    digest = constant("DIGEST_HIGH", "DIGITS") << 32 | constant("DIGEST_LOW", "DIGITS")
    banner = rendered(source, "hk_regs.h").splitlines()[0]
    assert f"from design {digest:012x};" in banner
    assert constant("RATE", "MILLIHERTZ") == 1000 * source.rate_hz
    assert constant("SENSOR", "GYRO_FULL_SCALE") == source.sensor.gyro_full_scale_deg_s
    assert constant("SENSOR", "DIVIDER") == 1000 / source.rate_hz - 1
    assert constant("FEATURES", "ROLL") == ("roll" in spec.axes)
    assert constant("FEATURES", "INTEGRAL") == (spec.integral is not None)
    assert (constant("FEATURES", "CHANNELS"), constant("FEATURES", "PIPELINED")) == (4, 1)
    assert constant("FORMATS", "BLEND") == spec.blend.format.fraction_bits
    assert constant("SCALES", "GRAVITY_COUNT") == spec.gravity_count


def test_vhdl_has_the_addresses(source: FilterDesign) -> None:
    text = rendered(source, "hk_regs_pkg.vhd")
    found = re.findall(r"constant (\w+)_word_c : hk_regs_word_t := to_unsigned\((\d+), 6\)", text)
    assert [(n.upper(), 4 * int(w)) for n, w in found] == [
        (r.name, r.address) for r in the_map(source).registers
    ]


def test_the_page_has_every_field(source: FilterDesign) -> None:
    text = rendered(source, "REGISTERS.md")
    for register in the_map(source).registers:
        assert f"| 0x{register.address:02X} | [{register.name}]" in text
        section = text.split(f"## {register.name}\n")[1].split("\n## ")[0]
        rows = re.findall(r"^\| (\d+)(?::(\d+))? \| (\w+) \|", section, flags=re.M)
        assert [(int(low or high), int(high), name) for high, low, name in rows] == [
            (f.low, f.high, f.name) for f in register.fields
        ]


def test_c_has_the_same_registers(source: FilterDesign, tmp_path: Path) -> None:
    if shutil.which("gcc") is None:
        pytest.skip("gcc is not installed")
    expected = []
    lines = []
    for register in the_map(source).registers:
        names = [f"{register.name}_OFFSET", f"{register.name}_RESET"]
        expected += [register.address, register.reset]
        for f in register.fields:
            names += [f"{register.name}_{f.name}_{kind}" for kind in ("MASK", "SHIFT", "BITS")]
            expected += [f.mask, f.low, f.width]
            lines.append(
                f"if (HK_REGS_GET({register.name}_{f.name}, UINT32_MAX) != "
                f"HK_REGS_PUT({register.name}_{f.name}, UINT32_MAX) >> {f.low}) return 1;"
            )
        lines += [f'printf("%lu\\n", (unsigned long)HK_REGS_{name});' for name in names]
    signed = [(0, 18), (0x1FFFF, 18), (0x20000, 18), (0x3FFFF, 18), (1 << 31, 32), (0xFFFFFFFF, 32)]
    lines += [
        f'printf("%ld\\n", (long)hk_regs_signed(UINT32_C({v}), {bits}U));' for v, bits in signed
    ]
    expected += [(v ^ 1 << bits - 1) - (1 << bits - 1) for v, bits in signed]
    (tmp_path / "hk_regs.h").write_text(rendered(source, "hk_regs.h"), encoding="ascii")
    program = "\n".join(['#include "hk_regs.h"', "#include <stdio.h>", "int main(void) {", *lines])
    (tmp_path / "main.c").write_text(f"{program}\nreturn 0;\n}}\n", encoding="ascii")
    flags = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror"]
    subprocess.run(["gcc", *flags, "main.c", "-o", "main"], cwd=tmp_path, check=True)
    output = subprocess.run(
        [str(tmp_path / "main")], check=True, capture_output=True, text=True
    ).stdout
    assert [int(line) for line in output.splitlines()] == expected


ACCESS = {"ro": "r", "rw": "rw", "w1c": "rw", "pulse": "w", "pop": "r"}


def test_systemrdl_has_the_same_registers(source: FilterDesign, tmp_path: Path) -> None:
    systemrdl = pytest.importorskip("systemrdl")
    path = tmp_path / "hk_regs.rdl"
    path.write_text(rendered(source, "hk_regs.rdl"), encoding="ascii")
    compiler = systemrdl.RDLCompiler()
    compiler.compile_file(str(path))
    found = list(compiler.elaborate().top.registers())
    assert len(found) == len(the_map(source).registers)
    for node, register in zip(found, the_map(source).registers, strict=True):
        assert (node.inst_name, node.absolute_address) == (register.name, register.address)
        for got, f in zip(node.fields(), register.fields, strict=True):
            assert (got.inst_name, got.low, got.high) == (f.name, f.low, f.high)
            assert got.get_property("sw").name == (ACCESS[f.access] if f.present else "r")
            in_hardware = f.present and f.source == "core" and f.access != "w1c"
            assert got.get_property("reset", default=f.reset) == f.reset
            assert (got.get_property("reset") is None) == (in_hardware or f.element in OWN)
            assert bool(got.get_property("onwrite")) == (f.access == "w1c")
            assert got.get_property("singlepulse") == (f.access == "pulse")


OWN = ("retuned", "staged", "committing")


def test_settings_in_si_units_are_those_of_the_design() -> None:
    source = DESIGNS["all"]
    spec, own = lower(source), settings(source)
    registers = the_map(source)
    for name, value in (
        ("BLEND", own.eta),
        ("INTEGRAL_GAIN", own.integral_gain_per_s2),
        ("TILT_OFFSET_ROLL", own.tilt_offset_rad[0]),
        ("TILT_OFFSET_PITCH", own.tilt_offset_rad[1]),
        ("GYRO_BIAS_ROLL", own.gyro_bias_rad_s[0]),
        ("GYRO_BIAS_PITCH", own.gyro_bias_rad_s[1]),
    ):
        assert setting_word(source, spec, name, value) == registers.register(name).reset
    for i, name in enumerate(("RATE_GAIN_ROLL", "RATE_GAIN_PITCH")):
        weight = 500.0 * 0.017453292519943295 / 32768 * (1.0 + own.gyro_scale[i])
        assert setting_word(source, spec, name, weight) == registers.register(name).reset
    lowest = setting_value(source, spec, "gate_lowest", spec.gate.lowest)
    assert lowest == pytest.approx(0.9 * STANDARD_GRAVITY_M_S2, rel=1e-3)


def test_words_survive_their_values() -> None:
    source = DESIGNS["all"]
    spec = lower(source)
    for register in the_map(source).registers:
        if register.fields[0].source == "setting":
            sign = 0 if register.name.startswith("GATE") else 1 << register.fields[0].high
            for word in (0, 1, 1000, register.reset, sign):
                extended = word - 2 * sign if word & sign else word
                value = setting_value(source, spec, register.name, word)
                assert setting_word(source, spec, register.name, value) == extended & 0xFFFFFFFF


def test_values_that_do_not_fit_are_refused() -> None:
    source = DESIGNS["plain"]
    spec = lower(source)
    for name, value in (("BLEND", -100.0), ("TILT_OFFSET_ROLL", 4.0), ("BLEND", float("nan"))):
        with pytest.raises(FormatError, match="the range is"):
            setting_word(source, spec, name, value)
    with pytest.raises(RenderError, match="no setting 'GATE_LOWEST'"):
        setting_value(source, spec, "GATE_LOWEST", 1)
