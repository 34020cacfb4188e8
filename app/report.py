"""A printable page: map, figures, settings and the stops in order. No Streamlit in here."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING

import numpy as np
import shapely

from . import maps, texts

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import NDArray

    from fieldmon.monitor import Today
    from fieldmon.robot import Robot

    from .figures import DayFigures
    from .units import Units

_WIDE = 900.0
_STYLE = """
.fm-report{font-family:system-ui,sans-serif;color:#111;background:#fff;max-width:1000px;
padding:12px}
.fm-report h1{font-size:1.5rem}.fm-report h2{font-size:1.1rem;margin-top:1.2em}
.fm-report table{border-collapse:collapse;font-size:.85rem}
.fm-report td,.fm-report th{border:1px solid #999;padding:2px 8px;text-align:right}
.fm-report svg{max-width:100%;height:auto;border:1px solid #ccc}
@media print{.fm-report table{page-break-inside:auto}.fm-report tr{page-break-inside:avoid}}
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


def html(facts: Facts, today: Today, stops: pd.DataFrame, days: list[DayFigures]) -> str:
    """Return the whole page."""
    title = escape(texts.REPORT_TITLE.format(name=facts.name, day=facts.day))
    parts = [
        f'<h1 dir="auto">{title}</h1>',
        _pairs(_figures(facts, today)),
        drawing(facts, today),
        maps.chance_legend(),
        maps.state_legend(texts.LEGEND_STATES),
    ]
    if days:
        parts += [f"<h2>{texts.REPORT_SEASON}</h2>", _season(facts, days)]
    parts += [f"<h2>{texts.REPORT_SETTINGS}</h2>", _pairs(_settings(facts))]
    if len(stops):
        table = stops.assign(**{texts.REPORT_TICK: "☐"})
        parts += [f"<h2>{texts.REPORT_ROUTE}</h2>", table.to_html(border=0)]
    body = f'<style>{_STYLE}</style><div class="fm-report">{"".join(parts)}</div>'
    return (
        f'<!DOCTYPE html><html><head><meta charset="utf-8"><title>{title}</title></head>'
        f"<body>{body}</body></html>"
    )


def drawing(facts: Facts, today: Today) -> str:
    """Return the plot as an SVG picture, north up: chance by colour, finds as rings, the route."""
    grid = today.scene.grid
    lonlat = grid.lonlat()
    outline = shapely.get_rings(shapely.get_parts(grid.frame.geometry_lonlat(grid.drivable_m)))
    low, high = shapely.bounds(shapely.geometrycollections(outline)).reshape(2, 2)
    squeeze = np.cos(np.deg2rad((low[1] + high[1]) / 2))
    span = (high - low) * [squeeze, 1.0]
    per_deg = _WIDE / max(span[0], span[1])

    def at(points: NDArray[np.float64]) -> NDArray[np.float64]:
        across = (points[:, 0] - low[0]) * squeeze * per_deg + 10
        return np.round(np.stack([across, (high[1] - points[:, 1]) * per_deg + 10], axis=1), 1)

    wide, tall = span * per_deg + 20
    size = max(0.35 * grid.plant_spacing_m * per_deg / 111_320.0, 1.0)
    parts = [_dots(at(lonlat), maps.by_chance(facts.chance), size)]
    parts += [_line(at(shapely.get_coordinates(ring)), "#46504a", 1.5) for ring in outline]
    if len(today.route):
        parts.append(_line(at(today.route.line_lonlat()), "#1450c8", 1.4))
    parts += [
        f'<circle cx="{x}" cy="{y}" r="{size + 3:.1f}" fill="none" stroke="#140000" '
        'stroke-width="2"/>'
        for x, y in at(lonlat[facts.state == 1]).tolist()
    ]
    label = escape(texts.MAP_ALT.format(name=facts.name, plants=len(grid), stops=len(today.route),
                                        finds=int((facts.state == 1).sum())))  # fmt: skip
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" role="img" aria-label="{label}" '
        f'viewBox="0 0 {wide:.0f} {tall:.0f}" width="{wide:.0f}">{"".join(parts)}</svg>'
    )


def _dots(places: NDArray[np.float64], shade: maps.Shade, size: float) -> str:
    """Return one path of little squares for each class: a few strokes instead of many dots."""
    parts = []
    for rank in np.unique(shade.rank):
        own = places[shade.rank == rank]
        colour = tuple(maps.CHANCE_COLOURS[rank])
        dots = "".join(f"M{x} {y}h0" for x, y in own.tolist())
        parts.append(
            f'<path d="{dots}" stroke="rgb{colour}" stroke-width="{2 * size:.1f}" '
            'stroke-linecap="square"/>'
        )
    return "".join(parts)


def _line(places: NDArray[np.float64], colour: str, wide: float) -> str:
    points = " ".join(f"{x},{y}" for x, y in places.tolist())
    return f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="{wide}"/>'


def _figures(facts: Facts, today: Today) -> dict[str, str]:
    route = today.route
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
        texts.LOOK: f"{robot.look_s:g}",
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
