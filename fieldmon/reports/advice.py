"""The advice of a day on one page: treat or not, where, how much, and what is assumed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import chance_figure, estimate, figure, share_figure, worded
from fieldmon.infestation.hotspots import hot_spots
from fieldmon.infestation.records import PRESENT
from fieldmon.io.spray_rate import litres_figure
from fieldmon.monitoring.estimates.figures_of_day import found_again
from fieldmon.monitoring.estimates.plant_states import shown_apart
from fieldmon.plot.grid import plant_numbers, row_ends
from fieldmon.reports import words
from fieldmon.reports.content import (
    Block,
    Illustration,
    KeyFigure,
    KeyFigures,
    NoteLines,
    Paragraph,
    Report,
    Sheet,
    Table,
)
from fieldmon.reports.day import legend_block, map_alt, passed_by
from fieldmon.reports.maps import PlotMap

if TYPE_CHECKING:
    from datetime import date

    from fieldmon.compute.units import Units
    from fieldmon.monitoring import Season
    from fieldmon.monitoring.advice.advice import Advice


def advice_report(
    season: Season, on: date, advice: Advice, units: Units, product: str = ""
) -> Report:
    """Return the report of what is advised after a day's work."""
    lead, *sentences = advice.sentences(units)
    with season.store.one_moment():
        again, plot = found_again(season, on), _map(season, on, advice, units)
    blocks: list[Block] = [
        Paragraph(lead, lead=True),
        *map(Paragraph, sentences),
        *([] if again is None else [Paragraph(again.sentence())]),
        _figures(advice, product, units),
        *plot,
        *([_zones(advice)] if len(advice.zones) else []),
        NoteLines(words.NOTES),
    ]
    title = worded(words.ADVICE_TITLE, day=units.day(on))
    name = season.plot.field.name
    return Report(name, title, on, (Sheet(words.ADVICE_SHEET, tuple(blocks)),))


def _figures(advice: Advice, product: str, units: Units) -> KeyFigures:
    zones = advice.zones
    share = worded(words.OF_PLANTED, share=share_figure(zones.m2 / zones.plot_m2),
                   of=units.square(zones.plot_m2))  # fmt: skip
    rate = worded(words.RATE, rate=advice.asked.rate_l_ha)
    return KeyFigures(
        (
            KeyFigure(words.AREA_SPRAYED, units.square(zones.m2), share),
            KeyFigure(words.PRODUCT, product or words.PRODUCT_OPEN, rate),
            KeyFigure(words.LIQUID, worded(words.LITRES, value=litres_figure(advice.litres))),
            KeyFigure(words.INFESTED_INSIDE, estimate(zones.inside),
                      worded(words.AND_ELSEWHERE, n=estimate(zones.outside))),
            KeyFigure(words.ENOUGH, chance_figure(advice.said.enough, drawn=True)),
        )
    )  # fmt: skip


def _map(season: Season, on: date, advice: Advice, units: Units) -> list[Block]:
    with season.store.one_moment():
        day, evening = season.settings.day(on), season.evening(on)
        state, recorded = shown_apart(season.history, day)
        passed = passed_by(season.history, day, state)
    grid = season.plot.grid
    what = PlotMap(
        grid, evening, state, hot_spots(grid, np.full(len(grid), -1, np.int8)),
        season.plot.aisles.gate_m, units,
        zones_m=tuple(grid.frame.geometry_m(area) for area in advice.outlines),
        recorded=recorded, passed=passed,
    )  # fmt: skip
    found = int(np.count_nonzero(state == PRESENT))
    alt = map_alt(season.plot.field.name, state, 0) if found else words.ADVICE_ALT
    signs = legend_block(zones=True, recorded=bool(recorded.any()), passed=bool(passed.any()))
    return [Illustration("", alt, what.draw, what.heights(80.0, 150.0)), signs]


def _zones(advice: Advice) -> Table:
    numbered = plant_numbers(advice.grid)
    rows = []
    for k, verdict in enumerate(advice.said.zones):
        mine = advice.zones.zone == k
        number, (start, end) = numbered.number[mine], row_ends(advice.grid, numbered.line[mine])
        rows.append(
            (
                f"{k + 1}",
                worded(words.FROM_TO, start=start, end=end),
                worded(words.FROM_TO, start=number.min(), end=number.max()),
                figure(int(np.count_nonzero(mine)), ","),
                share_figure(verdict.share),
                words.VERDICTS[verdict.verdict],
            )
        )
    return Table(
        words.ZONES, words.ZONES_COLUMNS, tuple(rows),
        (0.1, 0.15, 0.2, 0.15, 0.15, 0.25), rest=words.ZONES_REST, left=(5,),
    )  # fmt: skip
