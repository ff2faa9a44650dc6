"""Reports: one HTML file each, with figures drawn by matplotlib."""

from hostkit.report.tuning import write_tuning_report

__all__ = ["write_tuning_report"]
