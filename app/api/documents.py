"""What a season tells a phone or a robot, as JSON. No Streamlit in here.

Plants are numbered as in the season's file, from 0; columns of the plot are in that order.
"""

from __future__ import annotations

import json
from datetime import datetime, time, timedelta
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

from fieldmon.compute.arrays import run_ends
from fieldmon.compute.digest import digest
from fieldmon.errors import SettingError
from fieldmon.infestation.inspections import RESULT_NAMES
from fieldmon.infestation.records import ABSENT, PRESENT
from fieldmon.io.writers.day_file import faces
from fieldmon.monitoring import kept_open
from fieldmon.monitoring.days.day_ahead import (
    DayAhead,
    WorkPart,
    planned_again,
    route_ahead,
    work_hours,
)
from fieldmon.monitoring.estimates.derived_layers import spot_area
from fieldmon.monitoring.estimates.history import say_gone
from fieldmon.monitoring.estimates.last_days import last_date
from fieldmon.monitoring.estimates.plant_states import hot_spots_on, shown_apart
from fieldmon.monitoring.estimates.what_was_told import detection_of
from fieldmon.monitoring.inspecting.contradictions import contradicting
from fieldmon.monitoring.phones.findings import taken_back, taken_back_before
from fieldmon.monitoring.phones.photos import photos_of
from fieldmon.planning.skips import left_out
from fieldmon.plot.local_clock import local_clock, utc_now, utc_text

from ..state import last_heard

if TYPE_CHECKING:
    from datetime import date

    from numpy.typing import NDArray

    from fieldmon.infestation.inspections import Inspections
    from fieldmon.monitoring import Season
    from fieldmon.monitoring.phones.scouts import Scout
    from fieldmon.planning.route import Route
    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.robot import Robot
    from fieldmon.samplers.base import Scene

# seven digits of a degree are a centimetre
_DIGITS = 7
_FEW = 8


@lru_cache(maxsize=_FEW)
def plot_document(season: Season) -> tuple[str, bytes]:
    """Return a short name of what the plot is, and its document; it never changes."""
    grid, field = season.plot.grid, season.plot.field
    lonlat, rows = np.round(grid.lonlat(), _DIGITS), grid.unbroken
    document = {
        "name": field.name,
        "boundary": _geometry(field.boundary),
        "no_go": _geometry(field.no_go),
        "gate": None if field.gate is None else [round(v, _DIGITS) for v in field.gate],
        "zone": local_clock(field).zone,
        "row_spacing_m": grid.row_spacing_m,
        "plant_spacing_m": grid.plant_spacing_m,
        "rows": {
            "start": grid.unbroken_start.tolist(),
            "row": grid.row_line_number[rows].tolist(),
            "sign": [grid.line_signs[row] for row in grid.row_line_number[rows].tolist()],
            "aisle": grid.corridor[rows].tolist(),
            "side": (-grid.side[rows]).tolist(),
        },
        "plants": {
            "lon": lonlat[:, 0].tolist(),
            "lat": lonlat[:, 1].tolist(),
            "number": season.plant_numbers.number.tolist(),
            **(_faces(grid) if grid.has_faces else {}),
        },
    }
    made = _json(document)
    return digest(made, length=16), made


def _faces(grid: PlantGrid) -> dict[str, list[Any]]:
    """Return which face each plant is, and where it is drawn, as on the app's maps."""
    from ..show.maps.plant_layers import drawn_at  # noqa: PLC0415 - heavy

    drawn = np.round(drawn_at(grid), _DIGITS).T
    face = faces(grid, np.arange(len(grid)))
    return {"face": face.tolist(), "drawn_lon": drawn[0].tolist(), "drawn_lat": drawn[1].tolist()}


def day_document(season: Season, scout: Scout, on: date | None, has: int | None = None) -> bytes:
    """Return a day as it stands: the route left for this person, what is believed and known.

    `has`: the plan that the phone has and goes on by; None: it goes by what is returned.
    """
    with kept_open():
        return _json(_day_told(season, scout, _day(season, on), has))


def _day_told(season: Season, scout: Scout, on: date, has: int | None) -> dict[str, Any]:
    part = WorkPart(scout.rows, scout.name)
    route, history = route_ahead(season, on, part), season.history
    ahead = DayAhead.of(season, on)
    settings, plan, member = ahead.settings, ahead.plan_of(part), ahead.member(part)
    last_heard.note(season.path, scout.name, on, plan if has is None else has)
    robot = settings.robot if member is None else member.robot
    hours = work_hours(season, on, part)
    known, recorded = shown_apart(history, settings.day(on))
    mine = ahead.in_own_aisles(part)
    return {
        "season": season.path.stem,
        "scout": scout.name,
        "rows": ahead.rows(part),
        "others": _others(ahead.own(part), mine),
        "plot": plot_document(season)[0],
        "day": on.isoformat(),
        "live": on == _today(season),
        "past": on < _today(season),
        "starts": f"{settings.starts:%H:%M}",
        "robot": _charged(season.plot.aisles.worked_by(robot)),
        "begins": _moment(season, on, hours.begins_s),
        "begun": hours.run,
        # who has no route would be given the hours of a robot that a team does without
        "seconds_left": hours.left_s if ahead.has_route(part) else 0.0,
        "has_route": ahead.has_route(part),
        "route": _route(route, detection_of(season, on, scout.name)),
        "plan": plan,
        # evening: what was found today counts
        "chance": np.round(season.evening(on) * 1000).astype(int).tolist(),
        "found": np.flatnonzero(known == PRESENT).tolist(),
        "clean": np.flatnonzero(known == ABSENT).tolist(),
        "recorded": np.flatnonzero(recorded).tolist(),
        "gone": np.flatnonzero(history.gone(settings.day(on))).tolist(),
        "today": _said(history.inspections.on(on)),
        "contradicting": _said(contradicting(season.inspections.on(on))),
        "taken_back": list(taken_back(season, scout.name, on)),
        "taken_back_before": {
            day: list(ids) for day, ids in taken_back_before(season, scout.name, on).items()
        },
        "hot_spots": _hot_spots(season, on),
        "photos": [photo._asdict() for photo in photos_of(season)],
        "photos_asked": [one._asdict() for one in ahead.asked_of(part)],
        "closed": _closed(season, on, ahead.works_as(part), mine),
        "left_out": _left_out(season.scene(on, who=ahead.works_as(part)), route, mine),
        "unwanted": run_ends(np.unique(np.array(ahead.wished.wishes.unwanted, int))).tolist(),
    }


def _charged(robot: Robot) -> dict[str, Any]:
    """Return the hours of whoever inspects, and what its times are charged by."""
    return {
        "hours": robot.hours,
        "speed_m_s": robot.speed_m_s,
        "row_change_s": robot.row_change_s,
        "visit_s": robot.visit_s,
        "returns": robot.returns,
    }


def rest_document(
    season: Season, scout: Scout, on: date | None, seconds_left: float | None
) -> bytes:
    """Return the rest of a day, planned anew with all that is known."""
    with kept_open():
        on, part = _day(season, on), WorkPart(scout.rows, scout.name)
        route = planned_again(season, on, part, seconds_left)
        ahead = DayAhead.of(season, on)
        plan, others = ahead.plan_of(part), _others(ahead.own(part), ahead.in_own_aisles(part))
        told = _route(route, detection_of(season, on, scout.name))
    last_heard.note(season.path, scout.name, on, plan)
    return _json({"day": on.isoformat(), "route": told, "plan": plan, "others": others})


def _others(own: NDArray[np.bool_], mine: NDArray[np.bool_]) -> list[list[int]]:
    """Return somebody's `own` plants in aisles that others have, as runs: no find leads there."""
    runs: list[list[int]] = run_ends(np.flatnonzero(own & ~mine)).tolist()
    return runs


def _day(season: Season, on: date | None) -> date:
    """Return the day asked for; else today, or where that is not of the season, its last day."""
    if on is not None:
        season.settings.day(on)  # or raise
        return on
    today = _today(season)
    try:
        season.settings.day(today)
    except SettingError:
        return last_date(season)
    return today


def _today(season: Season) -> date:
    return local_clock(season.plot.field).at(utc_now()).date()


def _moment(season: Season, on: date, second: float) -> str:
    """Return a second of a day on the plot as a moment, in UTC."""
    local = datetime.combine(on, time()) + timedelta(seconds=round(second))
    return utc_text(local_clock(season.plot.field).moment(local.date(), local.time()))


def _route(route: Route, detects: float) -> dict[str, Any]:
    leave_s = np.concatenate([[0.0], route.leave_s[:-1]])
    walk_s = route.arrive_s - leave_s if len(route) else route.arrive_s
    line = np.round(route.line_lonlat(), _DIGITS) if len(route) else np.empty((0, 2))
    return {
        "plants": route.plant.tolist(),
        "walk_s": np.round(walk_s, 1).tolist(),
        "end_s": round(route.end_s, 1),
        "line": line.tolist(),
        "stops": route.line_stop.tolist(),
        "detects": round(detects, 6),
    }


def _said(inspections: Inspections) -> list[dict[str, Any]]:
    columns = zip(
        inspections.plant.tolist(),
        inspections.result.tolist(),
        inspections.count.tolist(),
        inspections.second.tolist(),
        inspections.who,
        say_gone(inspections).tolist(),
        strict=True,
    )
    return [
        {
            "plant": plant,
            "result": RESULT_NAMES[result],
            "count": None if np.isnan(count) else count,
            "second": None if np.isnan(second) else second,
            "who": str(who),
            **({"gone": True} if gone else {}),
        }
        for plant, result, count, second, who, gone in columns
    ]


def _closed(
    season: Season, on: date, works_as: str, mine: NDArray[np.bool_]
) -> list[dict[str, Any]]:
    """Return rows with plants that nobody may come to after a treatment, and until when.

    With which of their plants, as runs of numbers, and how many of these are somebody's own.
    """
    closed, line = [], season.plant_numbers.line
    for one in season.closed(on, works_as):
        rows = np.unique(line[one.plants])
        for run in run_ends(rows).tolist():
            plants = np.flatnonzero(one.plants & (line >= run[0]) & (line <= run[1]))
            closed.append(
                {
                    "rows": run,
                    "until": f"{one.until:%Y-%m-%dT%H:%M}",
                    "plants": run_ends(plants).tolist(),
                    "own": int(np.count_nonzero(mine[plants])),
                }
            )
    return closed


def _left_out(scene: Scene, route: Route, mine: NDArray[np.bool_]) -> list[dict[str, Any]]:
    """Return which plants are on no route though they are open, why, and how many are one's own."""
    return [
        {"why": why, "plants": run_ends(plants).tolist(), "own": int(mine[plants].sum())}
        for why, plants in left_out(scene, route).items()
        if len(plants)
    ]


def _hot_spots(season: Season, on: date) -> list[Any]:
    spots = hot_spots_on(season.history, season.settings.day(on))
    return [_geometry(spot_area(season.plot, spots, h)) for h in range(len(spots))]


def _geometry(geometry: shapely.Geometry) -> Any:  # noqa: ANN401 - GeoJSON
    rounded = shapely.transform(geometry, lambda xy: np.round(xy, _DIGITS))
    return json.loads(shapely.to_geojson(rounded))


def _json(document: object) -> bytes:
    return json.dumps(document, separators=(",", ":"), ensure_ascii=False).encode()
