"""Hand wrong values to every public name of the library: each must be refused in a sentence.

`python -m tests.wrong_values` tries every value for every parameter, and prints what is wrong.
"""

from __future__ import annotations

import inspect
import os
import resource
import sys
import tempfile
import time
import warnings
from dataclasses import dataclass, fields
from datetime import UTC, date, datetime
from datetime import time as clock
from functools import wraps
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
import rasterio
import shapely

import fieldmon as fm
from fieldmon.errors import FieldmonError, ImportDoubt
from tests.paths import SAMPLE_DATA

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

ESTATE, MITES = SAMPLE_DATA / "paran_estate.zip", SAMPLE_DATA / "mite_records.csv"
TODAY = date(2026, 11, 18)
_MOST_S, _MOST_KB = 5.0, 2_000_000

_NUMBERS = {
    "0": 0, "1": 1, "-1": -1, "half": 0.5, "-half": -0.5, "inf": np.inf, "-inf": -np.inf,
    "1e30": 1e30, "-1e30": -1e30, "10^30": 10**30, "-10^30": -(10**30), "2^63": 2**63,
}  # fmt: skip
#: what a program may hand over, by what it is called
VALUES: dict[str, Any] = {
    **_NUMBERS,
    "nan": np.nan, "10^400": 10**400, "complex": 1j, "true": True, "false": False,
    "None": None, "text": "soon", "empty text": "", "NUL": "a\0b", "bytes": b"12",
    "object": object(), "class": int, "function": len, "set": {1}, "dict": {},
    "dict of texts": {"a": "b"}, "empty list": [], "list": [1, 2], "ragged": [[1], [2, 3]],
    "list of None": [None, None], "list of texts": ["a", "b"], "list of 10^30": [10**30] * 3,
    "tuple": (1, 2, 3), "pair": (1.0, 2.0), "pair of nan": (np.nan, np.nan),
    "pair of texts": ("a", "b"), "far pair": (1e30, 1e30), "pair of True": (True, False),
    "empty array": np.empty(0), "array": np.zeros(5), "table": np.zeros((2, 2)),
    "cube": np.zeros((2, 2, 2)), "array of texts": np.array(["a", "b"]),
    "array of objects": np.array([None, "a"], object), "array of complex": np.zeros(3, complex),
    "array of dates": np.zeros(3, "datetime64[D]"), "array of nan": np.full(3, np.nan),
    "array of 1e30": np.full(3, 1e30), "array of -1": np.full(3, -1), "mask": np.zeros(3, bool),
    "date": TODAY, "first date": date.min, "last date": date.max, "time": clock(6),
    "moment": datetime(2026, 11, 18, 5, tzinfo=UTC), "NaT": pd.NaT,
    "numpy's NaT": np.datetime64("NaT"), "frame": pd.DataFrame({"a": [1]}),
    "series": pd.Series([1.0]), "path": Path("nowhere"), "empty area": shapely.MultiPolygon(),
    "point": shapely.Point(0, 0),
}  # fmt: skip

_DATES = {"date", "first date", "last date", "moment"}
_TEXTS = {"text", "empty text", "NUL"}
#: what each annotation allows; whatever else is taken is taken for something that it is not
_RIGHT = {
    "None": {"None"},
    "bool": {"true", "false"},
    "str": _TEXTS,
    "Path": {"path"},
    "int": {"0", "1", "-1", "10^30", "-10^30", "2^63"},
    "float": {*_NUMBERS},
    "date": _DATES,
    "Day": _DATES,
    "dt.date": _DATES,
    "datetime": {"moment"},
    "time": {"time"},
    "TimeOfDay": {"time"},
    "tuple[str, ...]": {"empty list", "list of texts", "pair of texts"},
    "Sequence[int]": {"empty list", "list", "tuple"},
    "tuple[int, ...]": {"empty list", "list", "tuple", "list of 10^30"},
    "dict[str, float]": {"dict"},
    "MultiPolygon": {"empty area"},
    "Floats": {"array", "table", "cube", "array of nan", "array of 1e30", "array of -1"},
}
_PARTS = ("Block", "Assumed", "TeamMember", "Stage", "Citation")
_RIGHT |= {f"tuple[{part}, ...]": {"empty list"} for part in _PARTS}
_ROWS = ("KeptMessage", "ArrayLike", "ProductLabel")
_RIGHT |= {f"Iterable[{row}]": {"empty list", "empty array"} for row in _ROWS}
_RIGHT["Sequence[tuple[Inspections, str]]"] = {"empty list"}
#: columns of as many entries as these values have: 3
_COLUMNS = {
    "second": {"tuple", "list of 10^30", "array of nan", "array of 1e30", "array of -1"},
    "count": {"tuple", "list of 10^30", "array of nan", "array of 1e30", "array of -1"},
    "plant": {"tuple", "array of -1"},
    "result": {"tuple", "mask"},
    "date": {"array of dates"},
    "on": {"array of dates", "moment", "numpy's NaT"},
    **{name: {"array of nan"} for name in ("who", "notes")},
}
_RECORDED = {"tuple", "list of 10^30", "array of nan", "array of 1e30", "array of -1"}
_PICKED = {"empty list", "list", "empty array", "array of -1", "mask"}
#: what is right of single parameters beside what their annotations allow
_FINE: dict[str, dict[str, set[str]]] = {
    "Inspections": _COLUMNS,
    "Inspections.of": _COLUMNS,
    "Inspections.take": {"which": _PICKED},
    "Inspections.on": {"date": {"moment", "numpy's NaT"}},
    "Records": {
        "present": {"array of -1"}, "day": {"array of dates"},
        **dict.fromkeys(("count", "accuracy_m", "leaves_sampled"), _RECORDED),
    },
    "Records.of": {
        "present": {"array of -1", "mask"}, "day": {"array of dates", "moment"},
        **{name: {"array of nan"} for name in ("species", "stage")},
        **dict.fromkeys(("count", "accuracy_m", "leaves_sampled"), _RECORDED),
    },
    "Records.take": {"which": _PICKED},
    "Field": {
        "gate": {"list", "pair"}, "plants": {"empty array", "table"},
        **{f"plant_{of}": {"empty array", "array of texts"} for of in ("rows", "blocks", "names")},
    },
    "Plot.without": {"missing": set()},
    "HotSpots": {
        "of_plant": {"empty array", "array of -1"},
        **{name: {"empty array"} for name in ("found", "inspected", "plants")},
        **{name: {"empty array"} for name in ("expected", "p", "q")},
    },
    "MonitorDay.ahead": {"n": {"0", "1", "-1", "10^30", "-10^30", "2^63"}},
    "MonitorDay.tell": {
        "found": {"None", "true", "false"},
        "at_s": {"None", "0", "1", "half"},
    },
    "BestRoute": {"plant": {"empty array", "array of -1"}},
    "routes.best": {"others": {"ragged"}},
    "Pest.infests_per_day": {"temperature_c": {"empty array"}},
    "Season.create": {
        "path": {"text", "path"}, "messages": {"None", "empty list", "empty array"},
        **{name: {"None"} for name in ("records", "settings", "risk")},
    },
    "SimulationSettings": {"believe": {"class", "function"}, "own_night": {"class", "function"}},
    "Increase": {name: {"list", "pair"} for name in ("at_c", "per_day")},
    "Movement": {"hours": {"list", "pair"}},
    # where that is, the plot says
    "TeamMember": {"gate": {"list", "pair", "far pair"}},
    "Learning": {"detection": {"empty array", "array"}},
    "Weather.chosen": {"which": {"empty array"}},
}  # fmt: skip
#: how sentences call parameters that they do not call by their names
_CALLED = {
    "at_s": ("clock",), "area": ("no area",), "as_format": ("can be written as",),
    "belief_settings": ("BeliefSettings",), "batch": ("number", "nothing to take back"),
    "bearing_deg": ("bearing",), "begins": ("Days and times",), "meaning": ("risk raster means",),
    "chance": ("chance map",), "copy": ("author", "file of a season"), "efficacy": ("works",),
    "feature": ("plot",), "found": ("What was seen", "hot spots"), "frame": ("GeoDataFrame",),
    "gate": ("Everything on a plot",), "inspection": ("number", "inspection"),
    "into": ("number", "batch"), "level": ("share of plants",), "lonlat": ("Positions",),
    "max_uses": ("one use or more",), "missing": ("Missing plants",), "name": ("Times",),
    "near": ("plot",),
    "n": ("team",), "numbers": ("number",), "on": ("day", "date", "season"),
    "others": ("Other routes",),
    "path": ("season", "file"),
    "plants": ("plant", "must be a file"), "present": ("Results",),
    "product": ("treatment",), "reentry_hours": ("Re-entry",), "reward": ("Rewards",),
    "risk": ("risk map",), "said": ("pest",), "seconds": ("time for a route",),
    "samplers": ("sampler",),
    "source": ("file",), "state": ("plant",), "step_s": ("step",), "steps": ("Viewpoints",),
    "rate_l_ha": ("rate in the zones",), "starts_s": ("start within a day",),
    "sure": ("to be right",), "value": ("dose",), "waiting_days": ("wait",),
    "water_l_ha": ("Water",), "width_m": ("width",),
    "who": ("named", "nobody", "author", "change of settings"),
}  # fmt: skip


#: of columns that do not belong together either may be named
_OF_ANY = ("must have the shape", "All columns")


@dataclass(frozen=True)
class Case:
    """A public call, and what is right to hand over to it."""

    name: str
    call: Callable[..., Any]
    right: dict[str, Any]

    def fault(self, parameter: str, label: str) -> str:
        """Return what is wrong with the answer to a value for one parameter; empty: nothing."""
        held_kb, given = _held_kb(), {**self.right, parameter: VALUES[label]}
        (said, how), took_s = self._timed(given)
        if took_s > _MOST_S:  # its loops were compiled, perhaps: that comes once
            _, took_s = self._timed(given)
        if took_s > _MOST_S or _held_kb() - held_kb > _MOST_KB:
            how = f"it took {took_s:.0f} s and {(_held_kb() - held_kb) / 1000:.0f} MB"
        elif said is None and not how and label not in self._allowed(parameter):
            how = "it is taken"
        elif how and label in {"class", "function"} and self._takes_functions(parameter):
            how = ""  # which is its own
        elif said is not None and not how and not self._names(said, parameter, label):
            how = f"the sentence does not name it: {said}"
        return f"{self.name}({parameter}={label}): {how}" if how else ""

    def _timed(self, arguments: dict[str, Any]) -> tuple[tuple[str | None, str], float]:
        """Return the answer, and the seconds of the processor that it took."""
        began = time.process_time()
        return self._answer(arguments), time.process_time() - began

    def _answer(self, arguments: dict[str, Any]) -> tuple[str | None, str]:
        """Return the sentence that refuses, if one does, and what else went wrong."""
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            warnings.simplefilter("ignore", ImportDoubt)
            try:
                repr(self.call(**arguments))
            except FieldmonError as refused:
                return str(refused), ""
            except Exception as error:  # noqa: BLE001 - what this is about
                return None, f"{type(error).__name__}: {error}"[:200]
        return None, ""

    def _names(self, said: str, parameter: str, label: str) -> bool:
        words = parameter, parameter.replace("_", " "), *_CALLED.get(parameter, ()), *_OF_ANY
        return VALUES[label] is self.right[parameter] or any(
            word.casefold() in said.casefold() for word in words
        )

    def _takes_functions(self, parameter: str) -> bool:
        return "Callable" in _annotations(self.call).get(parameter, "")

    def _allowed(self, parameter: str) -> set[str]:
        kinds = _annotations(self.call).get(parameter, "").split(" | ")
        own = _FINE.get(self.name, {}).get(parameter, set())
        if self._takes_functions(parameter):
            own = own | {"class", "function"}
        return own.union(*(_RIGHT.get(kind, set()) for kind in kinds))


def _annotations(call: Callable[..., Any]) -> dict[str, str]:
    told = inspect.signature(call).parameters
    return {name: str(one.annotation) for name, one in told.items()}


def _held_kb() -> int:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def _fields_of(made: object) -> dict[str, Any]:
    return {field.name: getattr(made, field.name) for field in fields(made) if field.init}  # type: ignore[arg-type]


def cases(folder: Path) -> Iterator[Case]:
    """Yield every public call, with what is right for each of its parameters."""
    plot = fm.read_plot(ESTATE, feature="Nursery")
    robot, n = fm.Robot(hours=0.5), len(plot.grid)
    day = fm.plan_day(plot, on=TODAY, robot=robot)
    yield from _of_plots(plot)
    yield from _of_records(plot)
    yield from _of_settings()
    yield from _of_pests()
    yield from _of_days(plot, day, folder)
    yield from _of_files(plot, folder)
    season = fm.Season.create(folder / "s.gpkg", plot, begins=TODAY, robot=robot)
    yield from _of_seasons(season, folder)
    spots = fm.hot_spots(plot.grid, np.arange(n) < 40)
    yield Case("HotSpots", fm.HotSpots, _fields_of(spots))
    yield Case("hot_spots", fm.hot_spots,
               {"plot": plot, "state": np.zeros(n), "settings": None})  # fmt: skip


def _of_plots(plot: fm.Plot) -> Iterator[Case]:
    field, lonlat = plot.field, plot.grid.lonlat()[:200]
    lines = [[(35.15, lat), (35.151, lat)] for lat in (30.36, 30.36004)]
    west, south, east, north = field.boundary.bounds
    across = shapely.LineString([(west, south), (east, north)])
    usual = {"name": "a", "planting": None, "gate": None}
    yield Case("Block", fm.Block, _fields_of(fm.Block("a", field.boundary)))
    yield Case("Field", fm.Field, _fields_of(field))
    yield Case("Field.frame", field.frame, {"bearing_deg": 90.0})
    yield Case("Planting", fm.Planting, _fields_of(fm.Planting()))
    yield Case("PlantingChoices", fm.PlantingChoices, _fields_of(fm.PlantingChoices()))
    yield Case("Plot", fm.Plot, _fields_of(plot))
    yield Case("Plot.along", fm.Plot.along, usual | {"rows": shapely.MultiLineString(lines)})
    yield Case("Plot.among", fm.Plot.among, {"name": "a", "plants": lonlat, "gate": None})
    yield Case("Plot.around", fm.Plot.around, usual | {"plants": lonlat, "names": None})
    yield Case("Plot.of", fm.Plot.of, {"field": field, "planting": None})
    yield Case("Plot.of_trees", fm.Plot.of_trees, {"field": field})
    yield Case("Plot.from_geopandas", fm.Plot.from_geopandas,
               usual | {"frame": plot.to_geopandas()})  # fmt: skip
    yield Case("Plot.with_gate", plot.with_gate, {"gate": tuple(lonlat[0])})
    yield Case("Plot.without", plot.without, {"missing": np.arange(len(plot.grid)) < 5})
    yield Case("cut_blocks", fm.cut_blocks, {"field": field, "line": across})


def _of_records(plot: fm.Plot) -> Iterator[Case]:
    seen = fm.Inspections.of([0, 1, 2], [0, 1, 2], TODAY)
    records = fm.Records.of([[35.15, 30.36]] * 3, [1, 0, 1], ["2026-11-10"] * 3)
    columns = {"count": [1, 2, 3], "second": [1.0, 2.0, 3.0], "who": ["a"] * 3, "notes": ["a"] * 3}
    yield Case("Inspections", fm.Inspections, _fields_of(seen))
    yield Case("Inspections.of", fm.Inspections.of,
               {"plant": [0, 1, 2], "result": [0, 1, 2], "on": TODAY, **columns})  # fmt: skip
    yield Case("Inspections.take", seen.take, {"which": seen.result == 1})
    yield Case("Inspections.and_those", seen.and_those, {"others": seen})
    yield Case("Inspections.on", seen.on, {"date": TODAY})
    yield Case("Records", fm.Records, _fields_of(records))
    yield Case("Records.of", fm.Records.of, _fields_of(records))
    yield Case("Records.take", records.take, {"which": records.present == 1})
    belief = fm.BeliefSettings()
    yield Case("BeliefSettings", fm.BeliefSettings, _fields_of(belief))
    chance = np.full(len(plot.grid), 0.1)
    morning = {"grid": plot.grid, "chance": chance, "pest": None}
    yield Case("BeliefSettings.first_morning", belief.first_morning, morning)


def _of_pests() -> Iterator[Case]:
    """Yield the parts of a pest."""
    parts = (
        fm.Citation("stages", "Sabelis 1981"), fm.Stage("egg", 12.0, 60.0, 36.0),
        fm.Increase((10.0, 30.0), (0.0, 0.3)), fm.Entry(),
        fm.Movement("exponential", per_day=0.1, reach_m=8.0, at_c=25.0),
    )  # fmt: skip
    for part in parts:
        yield Case(type(part).__name__, type(part), _fields_of(part))


def _of_settings() -> Iterator[Case]:
    pest, metrics = fm.read_pest("spider-mite"), [np.zeros(2) for _ in range(9)]
    metrics[3:6] = [np.zeros(2, int) for _ in range(3)]
    known = fm.SeasonMetrics(*metrics, visit=np.ones(2, bool))
    for made in (fm.Application(), fm.Dose(0.5, "l/ha"), fm.ProductLabel("a"), fm.rover(), pest,
                 fm.Spread(), fm.Viewpoints(), fm.SimulationSettings(), known,
                 fm.MonitoringSettings(TODAY), fm.PriorSettings(), fm.TeamMember("a"),
                 fm.Teamwork(), fm.AdviceSettings(), fm.Learning(), fm.TreatmentRule(),
                 fm.Sprayer(), fm.TreatmentCosts(), fm.HotSpotSettings(),
                 fm.CompareSettings(), fm.PestInWeather(pest), fm.Units(),
                 fm.Wishes()):  # fmt: skip
        yield Case(type(made).__name__, type(made), _fields_of(made))
    yield Case("Application.by_label", fm.Application().by_label, {"label": None})
    yield Case("Dose.share_of", fm.Dose(0.5, "l/ha").share_of,
               {"other": fm.Dose(1.0, "l/ha"), "water_l_ha": None})  # fmt: skip
    yield Case("ProductLabel.fits", fm.ProductLabel("a").fits,
               {"product": "a", "crop": "", "pest": ""})  # fmt: skip
    yield Case("Robot.with_hours", fm.Robot().with_hours, {"hours": 2.0})
    yield Case("Robot.with_times", fm.Robot().with_times, {"name": "thesis"})
    yield Case("Viewpoints.detection", fm.Viewpoints().detection, {"seconds": 20.0})
    yield Case("Pest.infests_per_day", pest.infests_per_day, {"temperature_c": 20.0})
    yield Case("Pest.seen_by", pest.seen_by, {"robot": fm.Robot()})
    yield Case("Pest.source", pest.source, {"part": "spread"})
    yield Case("SeasonMetrics.first_day", known.first_day, {"level_pct": 50.0})
    settings = fm.MonitoringSettings(TODAY)
    yield Case("MonitoringSettings.date", settings.date, {"day": 1})
    yield Case("MonitoringSettings.day", settings.day, {"on": TODAY})
    yield Case("MonitoringSettings.member", settings.member, {"who": "a"})


def _of_days(plot: fm.Plot, day: fm.DayPlan, folder: Path) -> Iterator[Case]:
    robot, chance = fm.Robot(hours=0.3), day.chance
    start = fm.draw_start(plot, chance)
    monitor = fm.Monitor(plot, "naive", robot)
    own = fm.SAMPLERS["naive"].load()()

    def begun() -> fm.MonitorDay:
        today = monitor.day_in(day.scene)
        today.ask()
        return today

    yield Case("DayPlan", fm.DayPlan, _fields_of(day))
    yield Case("Route", fm.Route, _fields_of(day.route))
    yield Case("Route.to_file", day.route.to_file,
               {"path": folder / "a.gpx", "as_format": None})  # fmt: skip
    yield Case("Start", fm.Start, _fields_of(start))
    yield Case("Monitor", fm.Monitor, {"plot": plot, "sampler": "naive", "robot": None,
               "chance": None, "belief_settings": None, "seed": 1, "pest": None})  # fmt: skip
    yield Case("Monitor.day_in", monitor.day_in, {"scene": day.scene})
    yield Case("Monitor.estimate", monitor.estimate, {"sure": 0.9})
    yield Case("Monitor.verdict", monitor.verdict, {"level": 0.05, "sure": 0.9})
    yield Case("Monitor.forecast", monitor.forecast, {"nights": 3})
    yield Case("MonitorDay", fm.MonitorDay,
               {"monitor": monitor, "scene": day.scene, "sampler": own})  # fmt: skip
    yield Case("MonitorDay.ahead", lambda n: begun().ahead(n), {"n": 3})
    yield Case("MonitorDay.tell", lambda found, at_s: begun().tell(found, at_s),
               {"found": True, "at_s": 100.0})  # fmt: skip
    yield Case("plan_day", fm.plan_day, {"plot": plot, "records": None, "on": TODAY,
               "robot": robot, "sampler": "naive", "risk": None})  # fmt: skip
    yield Case("draw_start", fm.draw_start,
               {"plot": plot, "chance": chance, "share": 0.02, "seed": 1})  # fmt: skip
    yield Case("simulate", fm.simulate, {"plot": plot, "start": start, "sampler": "naive",
               "robot": robot, "settings": fm.SimulationSettings(n_days=2), "seed": 1})  # fmt: skip
    yield Case("simulate_days", fm.simulate_days, {"plot": plot, "start": start,
               "sampler": "naive", "robot": robot, "settings": None, "seed": 1})  # fmt: skip
    yield Case("plan_team", fm.plan_team, {"plot": plot, "chance": chance,
               "members": fm.team_of(2, fm.Robot(hours=0.1)), "progress": None,
               "passing_m": 0.0, "on": TODAY})  # fmt: skip
    yield Case("team_of", fm.team_of, {"n": 2, "robot": None})
    brief = fm.CompareSettings(seeds=2, robot=robot, season=fm.SimulationSettings(n_days=1))
    yield Case("compare", fm.compare, {"plot": plot, "chance": chance, "samplers": ("naive",),
               "settings": brief, "progress": None, "stop": None})  # fmt: skip
    posed = {"plot": plot, "reward": chance, "robot": robot, "seconds": 0.1}
    yield Case("routes.best", fm.routes.best, posed | {"others": ()})
    yield Case("routes.bound", fm.routes.bound, posed | {"within_s": 0.1})
    best = fm.routes.best(plot, chance, robot)
    yield Case("BestRoute", fm.routes.BestRoute, _fields_of(best))
    yield Case("BestRoute.sentence", best.sentence, {"what": "finds"})


def _of_files(plot: fm.Plot, folder: Path) -> Iterator[Case]:
    station, findings = folder / "station.csv", folder / "findings.csv"
    station.write_text("Date,Tmin (C),Tmax (C)\n2026-11-16,10,20\n2026-11-17,11,20\n")
    findings.write_text("row,plant,date,found\n1,1,2026-11-18,yes\n")
    weather = fm.read_weather(station, plot)
    yield Case("Weather", fm.Weather, _fields_of(weather))
    yield Case("Weather.chosen", weather.chosen, {"which": np.ones(len(weather), bool)})
    first, end = np.datetime64("2026-11-16"), np.datetime64("2026-11-17")
    yield Case("Weather.between", weather.between, {"first": first, "end": end})
    yield Case("read_weather", fm.read_weather, {"source": station, "plot": plot})
    yield Case("read_inspections", fm.read_inspections, {"source": findings, "plot": plot})
    yield Case("read_records", fm.read_records, {"source": MITES, "near": plot})
    yield Case("read_pest", fm.read_pest, {"said": "spider-mite"})
    labels = folder / "labels.csv"
    labels.write_text("product\nSome oil\n")
    yield Case("read_labels", fm.read_labels, {"source": labels})
    yield Case("read_risk", fm.read_risk, {"source": _raster(plot, folder / "ndvi.tif"),
               "plot": plot, "meaning": "rank", "mean_share": 0.03, "how": None})  # fmt: skip
    yield Case("read_plots", fm.read_plots, {"source": ESTATE})
    yield Case("read_plot", fm.read_plot, {"source": ESTATE, "feature": "Nursery", "plants": None,
               "planting": None, "gate": None})  # fmt: skip


def _raster(plot: fm.Plot, path: Path) -> Path:
    """Return a raster over a plot."""
    lies = rasterio.transform.from_bounds(*plot.field.boundary.bounds, 4, 4)
    shape = {"width": 4, "height": 4, "count": 1, "dtype": "float32"}
    with rasterio.open(path, "w", crs="EPSG:4326", transform=lies, **shape) as file:
        file.write(np.linspace(0.2, 0.8, 16, dtype="float32").reshape(1, 4, 4))
    return path


def _of_seasons(season: fm.Season, folder: Path) -> Iterator[Case]:
    seen, settings = fm.Inspections.of([0, 1], [0, 1], TODAY), season.settings
    numbers = count()

    def create(path: Any, **more: Any) -> fm.Season:
        own = folder / f"{next(numbers)}.gpkg" if path is _NEW else path
        return fm.Season.create(own, season.plot, **more)

    yield Case("Season", fm.Season, {"path": season.path})
    yield Case("Season.create", create, {"path": _NEW, "records": None, "settings": None,
               "messages": (), "risk": None})  # fmt: skip
    on, who = {"on": TODAY}, {"who": ""}
    planned = on | {"now": None, "keep": True, "wishes": None}
    recorded = who | {"confirmed": False, "into": None}
    of_day = ("development", "evening", "forecast", "harvest_from",
              "learnt", "level_range", "morning", "status")  # fmt: skip
    methods = {
        **dict.fromkeys(of_day, on),
        "advice": on | {"asked": None},
        "cautions": on | {"units": None, "because_of": None},
        "change": who | {"settings": settings, "seen": settings},
        "contents": {"numbers": [1]},
        "correct": who,
        "effects": on | {"units": None},
        "keep_labels": who | {"labels": (), "source": ""},
        "kept_route": on | who,
        "merge": {"other": season},
        "numbered": on | {"plant": None},
        "plan": planned | {"who": None},
        "plan_each": planned,
        "record": recorded | {"inspections": seen, "source": ""},
        "record_all": recorded | {"brought": [(seen, "a")]},
        "scene": on | who | {"now": None},
        "take_corrections": who | {"copy": season.path, "name": "a"},
        "treat": on | {"efficacy": None, "area": None, "product": "", "application": None,
                       "plants": None},
        "to_geopandas": {"of": "plants", "on": TODAY},
        "undo": who | {"batch": None, "inspection": None},
        "undo_change": who,
        "verdict": on | {"level": 0.05, "sure": 0.9, "plants": None},
        "verify": {"whole": True},
    }  # fmt: skip

    @wraps(season.undo)
    def undo(**given: Any) -> object:
        season.record(seen)  # or there is nothing to take back
        return season.undo(**given)

    for name, right in methods.items():
        yield Case(f"Season.{name}", undo if name == "undo" else getattr(season, name), right)


_NEW = "a new file"


def faults(made: Sequence[Case], each: int | None = None, seed: int = 0) -> list[str]:
    """Return what is wrong with the answers to so many values for each parameter, drawn; None: all.

    Each is tried with other values than the next.
    """
    draws, labels = np.random.default_rng(seed), [*VALUES]

    def tried() -> list[str]:
        return labels if each is None else draws.choice(labels, each, replace=False).tolist()

    pairs = [(case, name, label) for case in made for name in case.right for label in tried()]
    return [said for case, name, label in pairs if (said := case.fault(name, label))]


def main() -> int:
    """Try everything."""
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        made = list(cases(Path(folder)))
        wrong = faults(made)
        print(*wrong, f"{len(made)} calls, {len(wrong)} faults", sep="\n")  # noqa: T201
        os.chdir("/")
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main())
