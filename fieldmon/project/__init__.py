"""A monitoring season on disk: one GeoPackage that grows with each day's findings."""

from __future__ import annotations

from fieldmon.project.batches import Batch
from fieldmon.project.contents import Remark
from fieldmon.project.project import Project, Recorded, Status
from fieldmon.project.results import NAMES, RESULTS, Results, counting_copy, results_from
from fieldmon.project.setup import Setup
from fieldmon.project.store import Store, is_season

__all__ = [
    "NAMES",
    "RESULTS",
    "Batch",
    "Project",
    "Recorded",
    "Remark",
    "Results",
    "Setup",
    "Status",
    "Store",
    "counting_copy",
    "is_season",
    "results_from",
]
