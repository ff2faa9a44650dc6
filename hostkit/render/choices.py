"""Options by kind of target: those of a firmware and those of an FPGA, and never the others."""

from dataclasses import fields

from hostkit.errors import RenderError
from hostkit.render.fpga_options import DEFAULT_FPGA_OPTIONS, FpgaOptions
from hostkit.render.options import DEFAULT_OPTIONS, FirmwareOptions
from hostkit.targets import Target

Options = FirmwareOptions | FpgaOptions


def default_options(target: Target) -> Options:
    """Return what a target has if nothing is chosen."""
    return DEFAULT_FPGA_OPTIONS if target.kind == "fpga" else DEFAULT_OPTIONS


def firmware_options_of(target: Target, options: Options | None) -> FirmwareOptions:
    """Return the options of a firmware, the defaults if there are none.

    Raises
    ------
    RenderError
        If something of an FPGA was chosen for a target that runs firmware.
    """
    if options is None or isinstance(options, FirmwareOptions):
        return options or DEFAULT_OPTIONS
    if options != DEFAULT_FPGA_OPTIONS:
        changed = ", ".join(_changed(options, DEFAULT_FPGA_OPTIONS))
        raise RenderError(f"{target.name} is no FPGA, so it has no options of one: {changed}")
    return DEFAULT_OPTIONS


def fpga_options_of(target: Target, options: Options | None) -> FpgaOptions:
    """Return the options of an FPGA, the defaults if there are none.

    Raises
    ------
    RenderError
        If something of a firmware was chosen for an FPGA.
    """
    if options is None or isinstance(options, FpgaOptions):
        return options or DEFAULT_FPGA_OPTIONS
    if options != DEFAULT_OPTIONS:
        changed = ", ".join(_changed(options, DEFAULT_OPTIONS))
        raise RenderError(f"{target.name} runs no firmware, so it has no options of one: {changed}")
    return DEFAULT_FPGA_OPTIONS


def _changed(options: Options, default: Options) -> list[str]:
    return [
        field.name
        for field in fields(options)
        if getattr(options, field.name) != getattr(default, field.name)
    ]
