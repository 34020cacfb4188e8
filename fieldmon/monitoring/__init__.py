"""A monitoring season on disk: one GeoPackage that grows with each day's findings."""

from __future__ import annotations

from fieldmon.monitoring.batches import Batch
from fieldmon.monitoring.day_figures import DayFigures, Progress
from fieldmon.monitoring.inspection_table import (
    NAMES,
    RESULTS,
    Results,
    counting_copy,
    results_from,
)
from fieldmon.monitoring.season_file import Recorded, Season, Status
from fieldmon.monitoring.settings import SeasonSetup
from fieldmon.monitoring.tables import Remark
from fieldmon.monitoring.transactions import Store, is_season
from fieldmon.monitoring.worked_route import worked_route

__all__ = [
    "NAMES",
    "RESULTS",
    "Batch",
    "DayFigures",
    "Progress",
    "Recorded",
    "Remark",
    "Results",
    "Season",
    "SeasonSetup",
    "Status",
    "Store",
    "counting_copy",
    "is_season",
    "results_from",
    "worked_route",
]
