"""A monitoring season on disk: one GeoPackage that grows with each day's findings."""

from __future__ import annotations

from fieldmon.monitoring.applications import Application
from fieldmon.monitoring.batches import Batch, Recorded
from fieldmon.monitoring.cautions import Caution
from fieldmon.monitoring.contradictions import Contradictions
from fieldmon.monitoring.day_figures import DayFigures, PlannedAndDone, Progress
from fieldmon.monitoring.merging.merge import Merged
from fieldmon.monitoring.outside_changes import OutsideChange
from fieldmon.monitoring.season_file import Season
from fieldmon.monitoring.season_log import LogEntry
from fieldmon.monitoring.settings import MonitoringSettings
from fieldmon.monitoring.status import Status
from fieldmon.monitoring.tables import KeptMessage
from fieldmon.monitoring.transactions import (
    Store,
    copy_season,
    is_season,
    kept_open,
    wait_until_free,
)
from fieldmon.monitoring.treatment_effect import TreatmentEffect
from fieldmon.monitoring.treatments import KeptTreatment
from fieldmon.monitoring.worked_route import day_was_worked, worked_route

__all__ = [
    "Application",
    "Batch",
    "Caution",
    "Contradictions",
    "DayFigures",
    "KeptMessage",
    "KeptTreatment",
    "LogEntry",
    "Merged",
    "MonitoringSettings",
    "OutsideChange",
    "PlannedAndDone",
    "Progress",
    "Recorded",
    "Season",
    "Status",
    "Store",
    "TreatmentEffect",
    "copy_season",
    "day_was_worked",
    "is_season",
    "kept_open",
    "wait_until_free",
    "worked_route",
]
