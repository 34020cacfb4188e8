"""Decide which plants to inspect for pests today, and learn from what is found.

>>> import fieldmon as fm
>>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
>>> records = fm.read_records("sample_data/mite_records.csv", near=plot)
>>> day = fm.plan_day(plot, records, "2026-11-18", robot=fm.Robot(hours=4))
>>> len(day.route) > 100
True

Names are loaded when they are first used, so that ``import fieldmon`` costs next to nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fieldmon.compute.units import Units
    from fieldmon.decisions.doses import Dose
    from fieldmon.decisions.labels import ProductLabel
    from fieldmon.decisions.library import read_labels
    from fieldmon.decisions.map_verdict import MapVerdict
    from fieldmon.decisions.sprayer import Sprayer, TreatmentCosts
    from fieldmon.errors import (
        ChoiceNeeded,
        ContradictionError,
        FieldmonError,
        FileProblem,
        ImportDoubt,
        NoRowsError,
        ObservationError,
        PlotError,
        SettingError,
    )
    from fieldmon.infestation.belief import Learning
    from fieldmon.infestation.forecast import Forecast
    from fieldmon.infestation.hotspots import HotSpots, HotSpotSettings, hot_spots
    from fieldmon.infestation.insects.pest_in_weather import PestInWeather
    from fieldmon.infestation.insects.spread import Spread
    from fieldmon.infestation.inspections import Inspections
    from fieldmon.infestation.plot_estimate import PlotEstimate
    from fieldmon.infestation.prior.prior_settings import PriorSettings
    from fieldmon.infestation.records import Records
    from fieldmon.io.library import (
        read_inspections,
        read_pest,
        read_plot,
        read_plots,
        read_records,
        read_risk,
        read_weather,
    )
    from fieldmon.io.plot_request import PlantingChoices
    from fieldmon.monitoring.estimates.asked_day import PlantToInspect
    from fieldmon.monitoring.estimates.monitor import Monitor, MonitorDay
    from fieldmon.monitoring.estimates.status import Status
    from fieldmon.monitoring.season.season_file import Season
    from fieldmon.monitoring.settings.advice_settings import AdviceSettings
    from fieldmon.monitoring.settings.belief_settings import BeliefSettings
    from fieldmon.monitoring.settings.settings import MonitoringSettings
    from fieldmon.monitoring.treating.applications import Application
    from fieldmon.pests.pest import Citation, Entry, Increase, Movement, Pest, Stage
    from fieldmon.pests.weather import Weather
    from fieldmon.planning import routes
    from fieldmon.planning.members import TeamMember, Teamwork, team_of
    from fieldmon.planning.plan import DayPlan, plan_day
    from fieldmon.planning.route import Route
    from fieldmon.planning.team import TeamPlan, plan_team
    from fieldmon.planning.wishes import Wishes
    from fieldmon.plot.block import Block
    from fieldmon.plot.block_cutting import cut_blocks
    from fieldmon.plot.field import Field
    from fieldmon.plot.plant_names import PlantNames
    from fieldmon.plot.planting import Planting
    from fieldmon.plot.plot import Plot
    from fieldmon.plot.robot import Robot, Viewpoints, rover, scout
    from fieldmon.samplers import SAMPLERS
    from fieldmon.samplers.base import Sampler, Scene, Stops
    from fieldmon.simulation.comparison import CompareSettings, Comparison, compare
    from fieldmon.simulation.library import draw_start, simulate, simulate_days
    from fieldmon.simulation.metrics import SeasonMetrics
    from fieldmon.simulation.season import SimulatedDay, SimulationSettings
    from fieldmon.simulation.start import Start
    from fieldmon.simulation.statistics import Ratio
    from fieldmon.simulation.treating import TreatmentRule

_MODULES = {
    "errors": (
        "ChoiceNeeded",
        "ContradictionError",
        "FieldmonError",
        "FileProblem",
        "ImportDoubt",
        "ObservationError",
        "NoRowsError",
        "PlotError",
        "SettingError",
    ),
    "compute.units": ("Units",),
    "decisions.doses": ("Dose",),
    "decisions.labels": ("ProductLabel",),
    "decisions.library": ("read_labels",),
    "decisions.sprayer": ("Sprayer", "TreatmentCosts"),
    "infestation.belief": ("Learning",),
    "infestation.insects.pest_in_weather": ("PestInWeather",),
    "infestation.hotspots": ("HotSpotSettings", "HotSpots", "hot_spots"),
    "infestation.inspections": ("Inspections",),
    "infestation.records": ("Records",),
    "infestation.insects.spread": ("Spread",),
    "io.library": (
        "read_inspections",
        "read_pest",
        "read_plot",
        "read_plots",
        "read_records",
        "read_risk",
        "read_weather",
    ),
    "monitoring.treating.applications": ("Application",),
    "monitoring.settings.belief_settings": ("BeliefSettings",),
    "monitoring.estimates.asked_day": ("PlantToInspect",),
    "monitoring.estimates.monitor": ("Monitor", "MonitorDay"),
    "monitoring.season.season_file": ("Season",),
    "monitoring.settings.settings": ("MonitoringSettings",),
    "pests.pest": ("Citation", "Entry", "Increase", "Movement", "Pest", "Stage"),
    "pests.weather": ("Weather",),
    "planning.plan": ("DayPlan", "plan_day"),
    "planning.route": ("Route",),
    "plot.block": ("Block",),
    "plot.block_cutting": ("cut_blocks",),
    "plot.field": ("Field",),
    "plot.plant_names": ("PlantNames",),
    "plot.planting": ("Planting",),
    "plot.plot": ("Plot",),
    "plot.robot": ("Robot", "Viewpoints", "rover", "scout"),
    "samplers": ("SAMPLERS",),
    "samplers.base": ("Sampler", "Scene", "Stops"),
    "decisions.map_verdict": ("MapVerdict",),
    "infestation.forecast": ("Forecast",),
    "infestation.plot_estimate": ("PlotEstimate",),
    "infestation.prior.prior_settings": ("PriorSettings",),
    "monitoring.settings.advice_settings": ("AdviceSettings",),
    "monitoring.estimates.status": ("Status",),
    "planning.members": ("TeamMember", "Teamwork", "team_of"),
    "planning.team": ("TeamPlan", "plan_team"),
    "planning.wishes": ("Wishes",),
    "simulation.comparison": ("CompareSettings", "Comparison", "compare"),
    "simulation.library": ("draw_start", "simulate", "simulate_days"),
    "simulation.metrics": ("SeasonMetrics",),
    "simulation.season": ("SimulationSettings", "SimulatedDay"),
    "simulation.start": ("Start",),
    "simulation.statistics": ("Ratio",),
    "simulation.treating": ("TreatmentRule",),
    "io.plot_request": ("PlantingChoices",),
}
#: names that are modules themselves
_AS_MODULES = {"routes": "planning.routes"}
_HOME = {name: module for module, names in _MODULES.items() for name in names}

__all__ = [
    "SAMPLERS",
    "AdviceSettings",
    "Application",
    "BeliefSettings",
    "Block",
    "ChoiceNeeded",
    "Citation",
    "CompareSettings",
    "Comparison",
    "ContradictionError",
    "DayPlan",
    "Dose",
    "Entry",
    "Field",
    "FieldmonError",
    "FileProblem",
    "Forecast",
    "HotSpotSettings",
    "HotSpots",
    "ImportDoubt",
    "Increase",
    "Inspections",
    "Learning",
    "MapVerdict",
    "Monitor",
    "MonitorDay",
    "MonitoringSettings",
    "Movement",
    "NoRowsError",
    "ObservationError",
    "Pest",
    "PestInWeather",
    "PlantNames",
    "PlantToInspect",
    "Planting",
    "PlantingChoices",
    "Plot",
    "PlotError",
    "PlotEstimate",
    "PriorSettings",
    "ProductLabel",
    "Ratio",
    "Records",
    "Robot",
    "Route",
    "Sampler",
    "Scene",
    "Season",
    "SeasonMetrics",
    "SettingError",
    "SimulatedDay",
    "SimulationSettings",
    "Sprayer",
    "Spread",
    "Stage",
    "Start",
    "Status",
    "Stops",
    "TeamMember",
    "TeamPlan",
    "Teamwork",
    "TreatmentCosts",
    "TreatmentRule",
    "Units",
    "Viewpoints",
    "Weather",
    "Wishes",
    "__version__",
    "compare",
    "cut_blocks",
    "draw_start",
    "hot_spots",
    "plan_day",
    "plan_team",
    "read_inspections",
    "read_labels",
    "read_pest",
    "read_plot",
    "read_plots",
    "read_records",
    "read_risk",
    "read_weather",
    "routes",
    "rover",
    "scout",
    "simulate",
    "simulate_days",
    "team_of",
]


def __getattr__(name: str) -> Any:  # noqa: ANN401 - any of the names above
    if name == "__version__":
        from importlib.metadata import version  # noqa: PLC0415 - slow, and seldom asked for

        return version("fieldmon")
    if name in _AS_MODULES:
        return import_module(f"fieldmon.{_AS_MODULES[name]}")
    if name not in _HOME:
        now = ": it is called Records now" if name == "Observations" else ""
        raise AttributeError(f"module 'fieldmon' has no attribute {name!r}{now}")
    value = getattr(import_module(f"fieldmon.{_HOME[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
