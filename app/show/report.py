"""A printable page: map, figures, settings and the stops in order. No Streamlit in here."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING

import numpy as np
import shapely

from ..words import texts
from .maps import colours, legends

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import NDArray

    from fieldmon.monitoring import DayFigures
    from fieldmon.planning.plan import DayPlan
    from fieldmon.planning.route import Route
    from fieldmon.plot.robot import Robot

    from ..words.units import Units

_WIDE = 900.0
_STOPS_A_TABLE = 60
_STYLE = """
.fm-report{font-family:system-ui,sans-serif;color:#111;background:#fff;max-width:1000px;
padding:12px}
.fm-report h1{font-size:1.5rem}.fm-report h2{font-size:1.1rem;margin-top:1.2em}
.fm-report table{border-collapse:collapse;font-size:.85rem}
.fm-report td,.fm-report th{border:1px solid #999;padding:2px 8px;text-align:right}
.fm-report svg.map{max-width:100%;height:auto;border:1px solid #ccc;margin:10px 0}
.fm-report .stops{display:flex;flex-wrap:wrap;gap:12px;align-items:flex-start}
.fm-report .stops table{font-size:.62rem}.fm-report .stops td,.fm-report .stops th{padding:0 2px}
@page{size:A4;margin:12mm}
@media print{.fm-report{padding:0}.fm-report svg.map{max-height:165mm}
.fm-report .stops{display:block}.fm-report h2{break-after:avoid}
.fm-report .stops table{display:inline-table;vertical-align:top;margin:0 3px 6px 0}
.fm-report table,.fm-report tr{break-inside:avoid}}
"""


@dataclass(frozen=True, eq=False)
class Facts:
    """What a report says beside the route."""

    name: str
    day: str
    units: Units
    chance: NDArray[np.float64]
    state: NDArray[np.int8]
    robot: Robot
    sampler: str
    route: Route
    results: dict[str, str]


def html(facts: Facts, plan: DayPlan, stops: pd.DataFrame, days: list[DayFigures]) -> str:
    """Return the whole page."""
    title = escape(texts.REPORT_TITLE.format(name=texts.isolated(facts.name), day=facts.day))
    parts = [
        f"<h1>{title}</h1>",
        _pairs(_figures(facts, plan)),
        drawing(facts),
        f"<strong>{texts.LEGEND_CHANCE}</strong>",
        legends.chance_legend(),
        legends.legend(
            [(colours.FOUND, texts.LEGEND_STATES["found"]),
             (colours.ROUTE, texts.MAP_LAYERS["route"]),
             (colours.GATE, texts.DRAW_KINDS["gate"])],
            signs=("find", "line", "ring"),
        ),
    ]  # fmt: skip
    if facts.results:
        parts += [f"<h2>{texts.REPORT_FOUND}</h2>", _pairs(facts.results)]
    if days:
        parts += [f"<h2>{texts.REPORT_SEASON}</h2>", _season(facts, days)]
    parts += [f"<h2>{texts.REPORT_SETTINGS}</h2>", _pairs(_settings(facts))]
    if len(stops):
        parts += [f"<h2>{texts.REPORT_ROUTE}</h2>", _stops(stops)]
    body = f'<style>{_STYLE}</style><div class="fm-report">{"".join(parts)}</div>'
    return (
        f'<!DOCTYPE html><html><head><meta charset="utf-8"><title>{title}</title></head>'
        f"<body>{body}</body></html>"
    )


def _stops(stops: pd.DataFrame) -> str:
    """Return the stops as tables side by side: a day's route is many pages long otherwise."""
    table = stops.assign(**{texts.REPORT_TICK: "☐"}).reset_index()
    parts = [table.iloc[k : k + _STOPS_A_TABLE] for k in range(0, len(table), _STOPS_A_TABLE)]
    return (
        '<div class="stops">'
        + "".join(part.to_html(border=0, index=False) for part in parts)
        + "</div>"
    )


def drawing(facts: Facts) -> str:
    """Return the plot as an SVG picture, north up: chance by colour, finds as rings, the route."""
    grid, route = facts.route.aisles.grid, facts.route
    lonlat = grid.lonlat()
    outline = shapely.get_rings(shapely.get_parts(grid.frame.geometry_lonlat(grid.drivable_m)))
    low, high = shapely.bounds(shapely.geometrycollections(outline)).reshape(2, 2)
    squeeze = np.cos(np.deg2rad((low[1] + high[1]) / 2))
    span = (high - low) * [squeeze, 1.0]
    per_deg = _WIDE / max(span[0], span[1])

    def at(points: NDArray[np.float64]) -> NDArray[np.float64]:
        across = (points[:, 0] - low[0]) * squeeze * per_deg + 10
        return np.round(np.stack([across, (high[1] - points[:, 1]) * per_deg + 10], axis=1), 1)

    wide, tall = span * per_deg + [20, 60]
    size = max(0.35 * grid.plant_spacing_m * per_deg / 111_320.0, 1.0)
    parts = [_dots(at(lonlat), colours.by_chance(facts.chance), size)]
    parts += [_line(at(shapely.get_coordinates(ring)), "#46504a", 1.5) for ring in outline]
    if len(route):
        parts.append(_line(at(route.line_lonlat()), "#1450c8", 1.4))
    parts += [
        f'<circle cx="{x}" cy="{y}" r="{size:.1f}" fill="rgb{colours.FOUND}" stroke="#140000" '
        'stroke-width="1.5"/>'
        for x, y in at(lonlat[facts.state == 1]).tolist()
    ]
    gate = at(grid.frame.lonlat(route.aisles.gate_m))[0]
    parts.append(f'<circle cx="{gate[0]}" cy="{gate[1]}" r="8" fill="none" '
                 f'stroke="rgb{colours.GATE}" stroke-width="4"/>')  # fmt: skip
    parts.append(_scale(facts.units, per_deg / 111_320.0, (wide, tall)))
    label = escape(texts.MAP_ALT.format(name=facts.name, plants=len(grid), stops=len(route),
                                        finds=int((facts.state == 1).sum())))  # fmt: skip
    return (
        f'<svg class="map" xmlns="http://www.w3.org/2000/svg" role="img" aria-label="{label}" '
        f'viewBox="0 0 {wide:.0f} {tall:.0f}" width="{wide:.0f}">{"".join(parts)}</svg>'
    )


def _dots(places: NDArray[np.float64], shade: colours.Shade, size: float) -> str:
    """Return one path of little squares for each class: a few strokes instead of many dots."""
    parts = []
    for rank in np.unique(shade.rank):
        own = places[shade.rank == rank]
        colour = tuple(colours.CHANCE_COLOURS[rank])
        # lines as long as they are wide: dots of no length are missing in a PDF
        dots = "".join(f"M{x - size:.1f} {y}h{2 * size:.1f}" for x, y in own.tolist())
        parts.append(f'<path d="{dots}" stroke="rgb{colour}" stroke-width="{2 * size:.1f}"/>')
    return "".join(parts)


def _scale(units: Units, per_m: float, corner: tuple[float, float]) -> str:
    """Return a bar of a round length in the lower left corner and an arrow to the north."""
    (wide, tall), ink = corner, "#222"
    bar_m, text = units.bar_m((wide - 20) / per_m / 4)
    end, y = 10 + bar_m * per_m, tall - 24
    return (
        _line(np.array([[10.0, y], [round(end, 1), y]]), ink, 4)
        + f'<text x="10" y="{y + 18:.0f}" font-size="16" fill="{ink}">{escape(text)}</text>'
        f'<path d="M{wide - 22:.0f} {tall - 10:.0f}l8 -26l8 26l-8 -7z" fill="{ink}"/>'
        f'<text x="{wide - 20:.0f}" y="{tall - 40:.0f}" font-size="16" fill="{ink}">N</text>'
    )


def _line(places: NDArray[np.float64], colour: str, wide: float) -> str:
    points = " ".join(f"{x},{y}" for x, y in places.tolist())
    return f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="{wide}"/>'


def _figures(facts: Facts, plan: DayPlan) -> dict[str, str]:
    route = plan.route
    return {
        texts.PLANTS_TO_INSPECT: f"{len(route):,} / {len(facts.chance):,}",
        texts.TIME: f"{route.end_s / 3600:.1f} h",
        texts.DRIVE: facts.units.metres(route.drive_m),
        texts.FINDS: f"{route.expected_found:.1f}",
    }


def _settings(facts: Facts) -> dict[str, str]:
    robot = facts.robot
    return {
        texts.SAMPLER: facts.sampler,
        texts.HOURS: f"{robot.hours:g}",
        texts.INSPECTION_S: f"{robot.look_s:g}",
        texts.SPEED: f"{robot.speed_m_s * 3.6:.1f} km/h",
        texts.DETECTS: f"{robot.detects:.0%}",
    }


def _season(facts: Facts, days: list[DayFigures]) -> str:
    heads = (texts.DATE, texts.VISITED_TODAY, texts.FOUND_TODAY, texts.EXPECTED_LEFT)
    rows = "".join(
        f"<tr><td>{facts.units.day(s.on)}</td><td>{s.inspected}</td>"
        f"<td>{s.found}</td><td>{s.expected:.1f} "
        f"({s.low}-{s.high})</td></tr>"
        for s in days
    )
    head = "".join(f"<th>{escape(name)}</th>" for name in heads)
    return f"<table><tr>{head}</tr>{rows}</table>"


def _pairs(values: dict[str, str]) -> str:
    rows = "".join(
        f"<tr><th>{escape(name)}</th><td>{escape(value)}</td></tr>"
        for name, value in values.items()
    )
    return f"<table>{rows}</table>"
