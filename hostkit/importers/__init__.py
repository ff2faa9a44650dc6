"""Other formats, turned into recordings."""

from hostkit.importers.formats import IMPORTERS, find
from hostkit.importers.log import Importer, Progress, ReferenceTrack, SensorLog
from hostkit.importers.options import ColumnChoice, ImportOptions, parse_columns
from hostkit.importers.pipeline import Imported, import_recording

__all__ = [
    "IMPORTERS",
    "ColumnChoice",
    "ImportOptions",
    "Imported",
    "Importer",
    "Progress",
    "ReferenceTrack",
    "SensorLog",
    "find",
    "import_recording",
    "parse_columns",
]
