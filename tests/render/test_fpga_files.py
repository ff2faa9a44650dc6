import re
import shutil
import subprocess
from pathlib import Path
from xml.etree import ElementTree

import pytest
from designs import all_parameters, design

from hostkit.errors import RenderError
from hostkit.render import FpgaOptions, render_target
from hostkit.render.fpga_options import Bus
from hostkit.render.vhdl_order import vhdl_order
from hostkit.targets import TARGETS

BUSES: tuple[Bus, ...] = ("none", "axi4lite", "wishbone")
PORT = re.compile(r"^    (\w+) +: (?:in|out|inout) ", re.MULTILINE)


def files_of(target: str, bus: Bus = "none", **options: object) -> dict[str, str]:
    chosen = FpgaOptions(bus=bus, **options)
    return {f.path: f.content for f in render_target(design(), TARGETS[target], chosen)}


def pads(top: str) -> set[str]:
    """Return the ports of a top that are no bus."""
    entity = top[top.index("entity") : top.index("architecture")]
    return {port for port in PORT.findall(entity) if not port.startswith(("bus_", "s_axi_", "wb_"))}


@pytest.mark.parametrize("bus", BUSES)
def test_constraints_name_exactly_the_ports_of_the_top(bus: Bus) -> None:
    files = files_of("spartan3adsp", bus)
    ports = pads(files["hk_top.vhd"])
    assert len(ports) == 9
    ucf = files["ise/hk_top.ucf"]
    assert set(re.findall(r'^NET "(\w+)" +IOSTANDARD', ucf, re.MULTILINE)) == ports
    assert set(re.findall(r'^NET "(\w+)"', ucf, re.MULTILINE)) == ports
    for board in TARGETS["spartan3adsp"].boards:
        pins = files[f"ise/pins_{board.name}.ucf"]
        assert set(re.findall(r'^#?NET "(\w+)" LOC = "\w+";', pins, re.MULTILINE)) == ports
        filled = re.findall(r'^NET "\w+" LOC = "(\w+)";', pins, re.MULTILINE)
        assert len(set(filled)) == len(filled) == sum(bool(pin.site) for pin in board.pins)
        assert ("GRLIB" in pins) == bool(filled)


@pytest.mark.parametrize("bus", BUSES)
def test_preferences_name_exactly_the_ports_of_the_top(bus: Bus) -> None:
    files = files_of("ecp5", bus)
    ports = pads(files["hk_top.vhd"])
    assert len(ports) == 10
    lpf = files["hk_top.lpf"]
    sites = dict(re.findall(r'^LOCATE COMP "(\w+)" SITE "(\w+)";', lpf, re.MULTILINE))
    assert set(sites) == ports == set(re.findall(r'^IOBUF PORT "(\w+)"', lpf, re.MULTILINE))
    assert len(set(sites.values())) == len(ports)


@pytest.mark.parametrize("target", ["spartan3adsp", "ecp5"])
def test_projects_list_every_source_once_in_one_order(target: str) -> None:
    files = files_of(target)
    benches = {path for path in files if path.endswith(("_tb.vhd", "_model.vhd"))}
    sources = {path for path in files if path.endswith(".vhd")} - benches
    listed = re.findall(r"^\d+\. \[(\S+)\]", files["README.md"], re.MULTILINE)
    assert set(listed) == sources
    assert len(listed) == len(sources)
    assert {f"[{path}]({path})" in files["README.md"] for path in files} == {True}
    if target == "ecp5":
        assert re.findall(r"^\t(\S+\.vhd)(?: \\)?$", files["Makefile"], re.MULTILINE) == listed
        return
    prj = re.findall(r'^vhdl work "../../(\S+)"$', files["ise/hk_top.prj"], re.MULTILINE)
    tcl = re.findall(r"^  \.\./(\S+)$", files["ise/project.tcl"], re.MULTILINE)
    assert prj == tcl == listed


def test_a_source_comes_after_what_it_needs() -> None:
    sources = {
        "a.vhd": "use work.b_pkg.all;\nentity a is\n",
        "b.vhd": "package b_pkg is\n-- use work.a.all; entity work.a\n",
        "c.vhd": "entity c is\n  x : entity work.a\n",
    }
    assert vhdl_order(sources) == ("b.vhd", "a.vhd", "c.vhd")
    with pytest.raises(RenderError, match="need each other"):
        vhdl_order({**sources, "b.vhd": "package b_pkg is\nuse work.c.all;\n"})
    with pytest.raises(RenderError, match=r"d\.vhd and a\.vhd both declare a"):
        vhdl_order({**sources, "d.vhd": "entity A is\n"})


def test_the_numbers_of_the_readme_are_those_of_the_design() -> None:
    text = files_of("spartan3adsp")["README.md"]
    assert "| latency of the filter | 54 clocks, 1.08 us at 50000000 Hz |" in text
    assert "| throughput of the filter | 909090 samples a second |" in text
    assert "| sensors of 100.0 Hz that one filter could serve | 9090 |" in text
    assert "| frame of a sample | 55 bytes, 4774 us on the line |" in text
    assert "Not measured" in text
    files = render_target(all_parameters(tilt="arcsin"), TARGETS["ecp5"])
    text = next(file.content for file in files if file.path == "README.md")
    assert "| latency of the filter | 83 clocks, 3.32 us at 25000000 Hz |" in text
    assert "| frame of a sample | 63 bytes" in text


@pytest.mark.parametrize("bus", BUSES)
def test_the_diagram_is_well_formed(bus: Bus) -> None:
    svg = files_of("ecp5", bus)["hk_system.svg"]
    ElementTree.fromstring(svg)
    assert ("hk_regs" in svg) == (bus != "none")


@pytest.mark.parametrize("target", ["spartan3adsp", "ecp5"])
def test_the_top_has_the_name_that_was_chosen(target: str) -> None:
    files = files_of(target, top_name="tilt_board")
    assert "entity tilt_board is" in files["tilt_board.vhd"]
    assert not any("hk_top" in path or "hk_top" in text for path, text in files.items())


@pytest.mark.parametrize("bus", BUSES)
def test_scripts_are_well_formed(bus: Bus, tmp_path: Path) -> None:
    files = files_of("spartan3adsp", bus)
    script, project = tmp_path / "build.sh", tmp_path / "project.tcl"
    script.write_text(files["ise/build.sh"])
    subprocess.run(["sh", "-n", script], check=True)
    if shutil.which("tclsh") is None:
        pytest.skip("tclsh is not installed: apt-get install tcl")
    project.write_text(files["ise/project.tcl"])
    (tmp_path / "check.tcl").write_text(
        "proc project args { puts [concat project $args] }\n"
        "proc xfile args { puts [concat xfile $args] }\n"
        f"set argv xc3sd1800a; set argc 1; source {project}\n"
    )
    done = subprocess.run(
        ["tclsh", tmp_path / "check.tcl"], check=True, capture_output=True, text=True
    )
    assert "project set device xc3sd1800a" in done.stdout
    assert "xfile add ../hk_top.vhd" in done.stdout
    assert "xfile add pins_xc3sd1800a.ucf" in done.stdout


def run_script(folder: Path, board: str) -> subprocess.CompletedProcess[str]:
    """Run build.sh with tools that only say how they were called."""
    tools = folder / "tools"
    tools.mkdir(exist_ok=True)
    for name in ("xst", "ngdbuild", "map", "par", "trce", "bitgen"):
        (tools / name).write_text(f'#!/bin/sh\necho {name} "$@"\n')
        (tools / name).chmod(0o755)
    return subprocess.run(
        ["sh", "ise/build.sh", board],
        cwd=folder,
        env={"PATH": f"{tools}:/usr/bin:/bin"},
        capture_output=True,
        text=True,
        check=False,
    )


def test_the_script_calls_the_tools_once_the_pins_are_filled_in(tmp_path: Path) -> None:
    (tmp_path / "ise").mkdir()
    for path, text in files_of("spartan3adsp").items():
        (tmp_path / path).write_text(text)
    refused = run_script(tmp_path, "xc3sd1800a")
    assert refused.returncode == 1
    assert "fill in these pins" in refused.stderr
    assert run_script(tmp_path, "basys3").returncode == 2
    pins = tmp_path / "ise" / "pins_xc3sd1800a.ucf"
    sites = iter(("A1", "A2", "A3"))
    lines = [
        line.removeprefix("#").replace("FILL_IN", next(sites))
        if 'LOC = "FILL_IN"' in line
        else line
        for line in pins.read_text().splitlines()
    ]
    pins.write_text("\n".join(lines) + "\n")
    done = run_script(tmp_path, "xc3sd1800a")
    assert done.returncode == 0, done.stderr
    called = [line.split()[0] for line in done.stdout.splitlines()][:6]
    assert called == ["xst", "ngdbuild", "map", "par", "trce", "bitgen"]
    assert "-p xc3sd1800a-4-fg676" in done.stdout
    build = tmp_path / "ise" / "build-xc3sd1800a"
    assert "-p xc3sd1800a-4-fg676\n" in (build / "hk_top.xst").read_text()
    for line in (build / "hk_top.prj").read_text().splitlines():
        assert (build / line.split('"')[1]).resolve().is_file()


@pytest.mark.parametrize("target", ["spartan3adsp", "ecp5"])
def test_a_top_with_a_bus_is_not_put_on_pins(target: str, tmp_path: Path) -> None:
    for path, text in files_of(target, "axi4lite").items():
        (tmp_path / path).parent.mkdir(exist_ok=True)
        (tmp_path / path).write_text(text)
    command = {"spartan3adsp": ["sh", "ise/build.sh"], "ecp5": ["make"]}[target]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode != 0
    assert "has the ports of a bus: instantiate it" in done.stderr
