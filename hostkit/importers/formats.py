"""The formats that can be imported, and which of them a file is."""

from pathlib import Path

from hostkit.errors import RecordingError
from hostkit.importers import ardupilot, broad, csv_log, mcap_log, repoimu, rosbag, tlog, ulog
from hostkit.importers.log import Importer
from hostkit.registry import Registry

IMPORTERS: Registry[Importer] = Registry(
    "importer",
    (
        csv_log.IMPORTER,
        tlog.IMPORTER,
        ardupilot.IMPORTER,
        ulog.IMPORTER,
        mcap_log.IMPORTER,
        rosbag.IMPORTER,
        broad.IMPORTER,
        repoimu.IMPORTER,
    ),
)


def find(path: Path, name: str | None) -> Importer:
    """Return the importer of a file.

    Parameters
    ----------
    path
        The file, or the folder of a rosbag2.
    name
        Name of the format; None to tell it from the content, or from the suffix where the content
        is of no known format.

    Raises
    ------
    RecordingError
        If no format is recognised, or several are.
    HostkitError
        If no format has that name.
    """
    if name is not None:
        return IMPORTERS[name]
    suffix = path.suffix.lower()
    found = [i for i in IMPORTERS if i.sniff(path)]
    if not found:
        found = [i for i in IMPORTERS if suffix in i.suffixes]
    for narrower in (
        [i for i in found if not i.generic],
        [i for i in found if suffix in i.suffixes],
    ):
        if len(found) > 1 and narrower:
            found = narrower
    if len(found) == 1:
        return found[0]
    listed = ", ".join(f"{i.name} ({i.title})" for i in (found or IMPORTERS))
    what = "it may be one of several formats" if found else "it is of no format that is known here"
    raise RecordingError(f"{path}: {what}: {listed}; say which: --format NAME")
