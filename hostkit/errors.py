"""The error tree: one class per cause, each with the exit code the command line returns."""


class HostkitError(Exception):
    """Base of every error that is reported as one line, without a traceback."""

    exit_code = 1


class RecordingError(HostkitError):
    """A recording cannot be read or is not fit for use."""


class DesignError(HostkitError):
    """A design file is malformed or asks for something impossible."""


class CalibrationError(HostkitError):
    """Recordings do not determine what a sensor reads wrong."""


class FormatError(HostkitError):
    """A number does not fit the fixed-point format it was given."""


class RenderError(HostkitError):
    """The code of a target cannot be rendered or written."""


class BuildError(HostkitError):
    """A compiler or a simulator refused generated code."""


class EmulationError(HostkitError):
    """An emulated board or a simulation did not run to its end."""


class VerdictError(HostkitError):
    """A validation came to its end and failed."""

    exit_code = 3


class DeviceError(HostkitError):
    """A port cannot be opened, or nothing that can be understood comes out of it."""

    exit_code = 4


class SchedulerError(DeviceError):
    """A scheduler cannot be reached or was lost, or its workers are not fit for the work."""


class FleetError(HostkitError):
    """Some devices of a fleet have no new design."""


class ToolMissingError(HostkitError):
    """A program hostkit calls is not installed."""

    exit_code = 5
