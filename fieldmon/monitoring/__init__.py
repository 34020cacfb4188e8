"""A monitoring season on disk: one GeoPackage that grows with each day's findings."""

from __future__ import annotations

from fieldmon.monitoring.changes.log_entry import LogEntry
from fieldmon.monitoring.changes.outside_changes import OutsideChange
from fieldmon.monitoring.changes.transactions import Store, copy_season, is_season
from fieldmon.monitoring.days.worked_route import day_was_worked, worked_route
from fieldmon.monitoring.estimates.day_figures import DayFigures, PlannedAndDone, Progress
from fieldmon.monitoring.estimates.status import Status
from fieldmon.monitoring.estimates.treatment_effect import TreatmentEffect
from fieldmon.monitoring.file.connections import kept_open, wait_until_free
from fieldmon.monitoring.file.tables import KeptMessage
from fieldmon.monitoring.inspecting.batches import Batch, Recorded
from fieldmon.monitoring.inspecting.contradictions import Contradictions
from fieldmon.monitoring.merging.merge import Merged
from fieldmon.monitoring.season.season_file import Season
from fieldmon.monitoring.settings.settings import MonitoringSettings
from fieldmon.monitoring.treating.applications import Application
from fieldmon.monitoring.treating.cautions import Caution
from fieldmon.monitoring.treating.treatments import KeptTreatment

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
