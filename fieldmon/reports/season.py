"""A season on four pages: where it stands, how it went, hot spots and finds, what it goes by."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import chance_figure, counted, estimate, figure, joined, worded
from fieldmon.errors import FieldmonError
from fieldmon.infestation.inspections import FOUND
from fieldmon.infestation.records import PRESENT
from fieldmon.monitoring import DayFigures
from fieldmon.monitoring.changes.earlier_settings import was_changed
from fieldmon.monitoring.days.kept_routes import planned_only
from fieldmon.monitoring.estimates.day_figures import flagged_said, found_pct
from fieldmon.monitoring.estimates.figures_of_day import found_again
from fieldmon.monitoring.estimates.last_days import last_date
from fieldmon.monitoring.estimates.plant_states import finds_apart, not_inspected_said
from fieldmon.plot.grid import plant_numbers, rows_listed
from fieldmon.plot.local_clock import local_clock
from fieldmon.reports import words
from fieldmon.reports.charts import DayChart
from fieldmon.reports.content import (
    Block,
    Illustration,
    KeyFigure,
    KeyFigures,
    Listing,
    NoteLines,
    Paragraph,
    Report,
    Sheet,
    Table,
)
from fieldmon.reports.day import (
    NO_ROW,
    held_in_words,
    legend_block,
    map_alt,
    passed_by,
    treatment_table,
    which,
)
from fieldmon.reports.maps import PlotMap
from fieldmon.reports.sentences import changed_later, hot_spot_meanings
from fieldmon.reports.settings_rows import (
    WorkSettings,
    assumed_sentence,
    changed_rows,
    settings_blocks,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Sized
    from datetime import date

    from numpy.typing import NDArray

    from fieldmon.compute.units import Units
    from fieldmon.monitoring import Season, Status
    from fieldmon.monitoring.inspecting.batches import Batch, BatchContents

_LATE_DAYS = 7
# as many as a page has room for beside its map
_MOST_CAUTIONS, _MOST_EFFECTS, _MOST_CHANGES, _MOST_OTHERWISE = 6, 3, 6, 6
# of so many batches it is said who inspected: more than fit on a page
_BATCHES_NAMED = 100
# as many letters as a line of rows, and a column of plants, may have
_ROWS_LONG, _FINDS_LONG = 70, 46


@dataclass(frozen=True, eq=False)
class _Facts:
    """What a season knows on a day."""

    season: Season
    on: date
    units: Units
    status: Status
    days: tuple[DayFigures, ...]
    found_by: NDArray[np.int64]

    @classmethod
    def of(cls, season: Season, on: date, units: Units) -> _Facts:
        status = season.status(on)
        today = DayFigures(
            on, status.inspected_today, status.found_today, status.estimate.expected,
            status.estimate.low, status.estimate.high, status.estimate.chance_clean,
        )  # fmt: skip
        days = (*(one for one in season.days() if one.on < on), today)
        return cls(season, on, units, status, days, _found_by(season, days))

    @property
    def name(self) -> str:
        return self.season.plot.field.name

    @cached_property
    def goes_by(self) -> WorkSettings:
        return self.in_force[-1][1].with_learnt(self.season, self.on)

    @cached_property
    def in_force(self) -> list[tuple[date, WorkSettings]]:
        """What counted on each day that was worked and, if it lies ahead, on the last one."""
        season = self.season
        worked = [one.on for one in self.days if one.inspected_today]
        recorded = season.inspections.date
        is_ahead = not len(recorded) or np.datetime64(self.on, "D") > recorded[-1]
        if not was_changed(season):
            worked = []  # the same on all of them
        by = [(day, WorkSettings.of_season(season, day, worked=True)) for day in worked]
        if is_ahead or not by:
            by.append((self.on, WorkSettings.of_season(season, self.on)))
        return by

    @property
    def state(self) -> NDArray[np.int8]:
        return self.season.history.states(self.status.day)

    def plot_map(self, *, by_state: bool) -> Iterator[Block]:
        """Yield the map of plants by chance or by what was found there, and its legend."""
        plot, state = self.season.plot, self.state
        passed = passed_by(self.season.history, self.status.day, state)
        what = PlotMap(
            plot.grid, self.season.evening(self.on), state, self.status.hot_spots,
            plot.aisles.gate_m, self.units, by_state=by_state, passed=passed,
        )  # fmt: skip
        yield Illustration("", map_alt(self.name, state, 0), what.draw, what.heights(75.0, 200.0))
        yield legend_block(by_state=by_state, passed=bool(passed.any()))


def _found_by(season: Season, days: tuple[DayFigures, ...]) -> NDArray[np.int64]:
    """Return how many plants were found infested up to the evening of each day."""
    history, settings = season.history, season.settings
    finds = np.flatnonzero(history.inspections.result == FOUND)
    _, first = np.unique(history.inspections.plant[finds], return_index=True)
    asked = [settings.day(one.on) for one in days]
    found_by: NDArray[np.int64] = np.searchsorted(
        np.sort(history.days[finds[first]]), asked, side="right"
    )
    return found_by


def season_report(season: Season, on: date, units: Units) -> Report:
    """Return the report of a season up to a day; nothing is kept by it."""
    with season.store.one_moment():
        facts, begins = _Facts.of(season, on, units), season.settings.begins
        made = (_stands(facts), _went(facts), _hot_and_found(facts), _goes_by(facts))
        sheets = tuple(
            Sheet(heading, tuple(blocks))
            for heading, blocks in zip(words.SEASON_SHEETS, made, strict=True)
        )
    title = worded(words.SEASON_TITLE, begins=units.day(begins), day=units.day(on))
    return Report(facts.name, title, on, sheets)


# -- where it stands


def _stands(facts: _Facts) -> Iterator[Block]:
    status, ahead, still = facts.status, facts.status.estimate, facts.status.infested
    said = [
        worded(words.STANDS,
            expected=estimate(still.expected), low=still.low, high=still.high,
            found=counted(status.found, "plant"),
        )
    ]  # fmt: skip
    said += flagged_said(ahead, status.flagged)
    if ahead.chance_clean >= 0.005:
        said.append(worded(words.STANDS_CLEAN, chance=chance_figure(ahead.chance_clean, 1)))
    if len(status.hot_spots):
        said.append(worded(words.STANDS_HOT, n=counted(len(status.hot_spots), "hot spot")))
    yield Paragraph(joined(" ", said), lead=True)
    yield _figures(facts)
    if away := not_inspected_said(facts.season.history, status.day):
        yield Paragraph(joined(" ", away))
    assumed = assumed_sentence(facts.goes_by, facts.units)
    if assumed:
        yield Paragraph(assumed)
    if (again := found_again(facts.season, facts.on)) is not None:
        yield Paragraph(again.sentence())
    beware = facts.season.cautions(facts.on, facts.units)
    if beware:
        sentences = tuple(dict.fromkeys(one.sentence for one in beware))
        rest = _left_out(sentences, _MOST_CAUTIONS, words.REST)
        yield Listing(words.CERT_CAUTIONS, (*sentences[:_MOST_CAUTIONS], *rest))
    yield from facts.plot_map(by_state=False)
    yield Paragraph(joined(" ", _rows_seen(facts)))


def _left_out(all_of: Sized, most: int, rest: str) -> tuple[str, ...]:
    """Return what is said of those for which a page has no room."""
    more = len(all_of) - most
    return (worded(rest, n=more),) if more > 0 else ()


def _figures(facts: _Facts) -> KeyFigures:
    status, ahead, still = facts.status, facts.status.estimate, facts.status.infested
    finds = sum(one.found_today for one in facts.days)
    twice = worded(words.FOUND_TWICE, n=finds) if finds != status.found else ""
    return KeyFigures(
        (
            KeyFigure(words.STILL, estimate(still.expected),
                      worded(words.INTERVAL, low=figure(still.low), high=figure(still.high))),
            KeyFigure(words.FOUND_SO_FAR, figure(status.found), twice),
            _share_found(status),
            KeyFigure(words.INSPECTED, figure(status.inspected),
                      worded(words.OF_PLANTS, n=status.plants)),
            KeyFigure(words.CLEAN, chance_figure(ahead.chance_clean, 1), words.CLEAN_NOTE),
            KeyFigure(words.HOT_SPOTS, figure(len(status.hot_spots)), words.HOT_NOTE),
        )
    )  # fmt: skip


def _share_found(status: Status) -> KeyFigure:
    if not status.inspected:
        return KeyFigure(words.SHARE_FOUND, NO_ROW, words.NOTHING_INSPECTED)
    low, high = status.detection_range_pct
    interval = worded(words.INTERVAL, low=chance_figure(low / 100), high=chance_figure(high / 100))
    return KeyFigure(words.SHARE_FOUND, chance_figure(status.detection_pct / 100), interval)


def _rows_seen(facts: _Facts) -> Iterator[str]:
    """Yield which rows nobody was in, ever or for a week."""
    line = facts.season.plot.grid.row_line_number
    lines = np.unique(line)
    days = np.array([_least(facts.status.days_since[line == one]) for one in lines.tolist()])
    never, late = lines[np.isinf(days)], lines[np.isfinite(days) & (days >= _LATE_DAYS)]
    for said, rows in ((words.ROWS_UNSEEN, never), (words.ROWS_LATE, late)):
        if len(rows):
            numbers = rows_listed(facts.season.plot.grid, rows)
            listed = worded(words.ROWS_NAMED if len(rows) > 1 else words.ROW, low=numbers)
            long = len(listed) > _ROWS_LONG
            yield worded(said, rows=counted(len(rows), "row") if long else listed)
    if not len(never) and not len(late):
        yield words.ROWS_ALL


def _least(days: NDArray[np.float64]) -> float:
    known = days[~np.isnan(days)]
    return float(known.min()) if len(known) else float("inf")


# -- how it went


def _went(facts: _Facts) -> Iterator[Block]:
    on = tuple(one.on for one in facts.days)
    still, low, high = (
        np.array([getattr(one, name) for one in facts.days], np.float64)
        for name in ("expected", "low", "high")
    )
    share, least, most = (
        np.array([found_pct(f, e) for f, e in zip(facts.found_by.tolist(), left, strict=True)])
        for left in (still.tolist(), high.tolist(), low.tolist())
    )
    found = np.array([one.found_today for one in facts.days], np.float64)
    inspected = np.array([one.inspected_today for one in facts.days], np.float64)
    share[np.cumsum(inspected) == 0] = np.nan  # of no inspections none is known
    charts = {
        words.CHART_FOUND: DayChart(on, found, facts.units),
        words.CHART_SHARE: DayChart(
            on, share, facts.units, least, most, top=100.0, marks=_treated(facts)
        ),
        words.CHART_STILL: DayChart(on, still, facts.units, low, high, marks=_treated(facts)),
        words.CHART_INSPECTED: DayChart(on, inspected, facts.units),
    }
    if np.isnan(share).all():
        del charts[words.CHART_SHARE]
    for title, chart in charts.items():
        yield Illustration(title, worded(words.CHART_ALT, title=title), chart.draw, (28.0, 46.0))
    plans = [facts.season.planned_and_done(one.on) for one in facts.days if one.inspected_today]
    # of a date on which only the shift of the day before went on, no plan was worked
    if held := [one for one in plans if one is not None and one.done + one.added]:
        days = counted(len(held), "day")
        said = worded(words.PLANNED_DONE, **held_in_words(held))
        yield Paragraph(joined(" ", (worded(words.PLANNED_DAYS, days=days), said)))
    if missing := planned_only(facts.season, facts.on):
        listed = ", ".join(map(facts.units.day, missing))
        yield Paragraph(worded(words.PLANNED_UNRECORDED, days=listed))
    yield _days(facts)


def _treated(facts: _Facts) -> tuple[tuple[date, str], ...]:
    """Return the days after which something was treated."""
    days = {one.day for one in facts.season.history.treatments}
    settings = facts.season.settings
    return tuple((settings.date(day), words.CHART_TREATED) for day in sorted(days))


def _days(facts: _Facts) -> Table:
    so_far = np.cumsum([one.inspected_today for one in facts.days]).tolist()
    rows = [
        (
            facts.units.day(one.on), figure(one.inspected_today), figure(one.found_today),
            worded("{n} ({low:,}–{high:,})", n=estimate(one.expected), low=one.low, high=one.high),
            chance_figure(found_pct(found, one.expected) / 100) if inspected else NO_ROW,
        )
        for one, found, inspected in zip(facts.days, facts.found_by.tolist(), so_far, strict=True)
    ]  # fmt: skip
    return Table(
        words.DAYS, words.DAY_COLUMNS, tuple(rows[::-1]), (0.22, 0.17, 0.12, 0.31, 0.18), flow=2,
        rest=words.DAYS_REST, left=(0,),
    )  # fmt: skip


# -- hot spots and finds


def _hot_and_found(facts: _Facts) -> Iterator[Block]:
    grid = facts.season.plot.grid
    yield from facts.plot_map(by_state=True)
    apart = finds_apart(facts.season.history, facts.status.day)
    meanings = tuple(hot_spot_meanings(grid, facts.status.hot_spots, apart))
    yield Listing(words.HOT_LIST, meanings, numbered=bool(len(facts.status.hot_spots)))
    yield from map(Paragraph, _left_out(facts.status.hot_spots, len(meanings), words.REST))
    if len(records := facts.season.records_known()):
        yield Paragraph(records.sentence(facts.units))
    plants = np.flatnonzero(facts.state == PRESENT)
    if not len(plants):
        yield Paragraph(words.FINDS_NONE)
        return
    numbered = plant_numbers(grid, plants)
    rows = []
    for line in np.unique(numbered.line).tolist():
        own = numbered.number[numbered.line == line].tolist()
        row = grid.line_signs[line] if grid.in_rows else NO_ROW
        rows.append((row, f"{len(own)}", which(own, _FINDS_LONG)))
    yield Table(
        words.FINDS_BY_ROW, words.FINDS_COLUMNS, tuple(rows), (0.12, 0.12, 0.76), flow=2,
        rest=words.REST, left=(2,),
    )  # fmt: skip


# -- what it goes by


def _goes_by(facts: _Facts) -> Iterator[Block]:
    yield _batches(facts)
    if changed := _changed_later(facts):
        # more than the last ones have no room
        rest = _left_out(changed, _MOST_CHANGES, words.CHANGED_LATER_REST)
        yield Listing(words.CHANGED_LATER, (*changed[-_MOST_CHANGES:], *rest))
    if otherwise := facts.season.other_detections(facts.on):
        rest = _left_out(otherwise, _MOST_OTHERWISE, words.REST)
        yield Listing("", (*(one.sentence() for one in otherwise[:_MOST_OTHERWISE]), *rest))
    yield _treatments(facts)
    told = [one for one in facts.season.effects(facts.on, facts.units) if one.before.inspected]
    if told:
        earlier = _left_out(told, _MOST_EFFECTS, words.EARLIER_REST)
        yield Listing("", (*(one.sentence() for one in told[-_MOST_EFFECTS:]), *earlier))
    yield from settings_blocks(facts.goes_by, facts.units)
    if changes := tuple(_changes(facts)):
        earlier = _left_out(changes, _MOST_CHANGES, words.EARLIER_REST)
        yield Listing(words.CHANGES, (*changes[-_MOST_CHANGES:], *earlier))
    yield Listing(words.MEANING, words.MEANINGS)
    yield NoteLines(words.NOTES)


def _changes(facts: _Facts) -> Iterator[str]:
    """Yield on which days who worked, or how, was another than before."""
    for (_, before), (day, now) in pairwise(facts.in_force):
        if rows := changed_rows(before, now, facts.units):
            yield worded(words.CHANGED_ON, day=facts.units.day(day), what=joined("; ", rows))


def _batches(facts: _Facts) -> Block:
    batches = facts.season.batches()
    contents = facts.season.contents([one.number for one in batches[:_BATCHES_NAMED]])
    if facts.on < last_date(facts.season):
        # what is of later days only came later
        contents = facts.season.contents([one.number for one in batches])
        later = {number for number, of in contents.items() if of.first > str(facts.on)}
        batches = tuple(one for one in batches if one.number not in later)
    brought = len(facts.season.records)
    if not batches and not brought:
        return Listing(words.BATCHES, (words.BATCHES_NONE,))
    rows, clock = [], local_clock(facts.season.plot.field)
    for one in batches:
        kind = words.BATCH_KINDS[one.kind]
        said = _counts(one, kind, contents.get(one.number))
        at = clock.at(datetime.fromisoformat(one.at))
        when = f"{facts.units.day(at.date())} {at:%H:%M}"
        who = one.by(contents.get(one.number))
        source = words.SOURCES.get(one.source, one.source)
        rows.append((when, said, source, who, figure(one.rows)))
    if brought:
        begins = facts.units.day(facts.season.settings.begins)
        rows.append((begins, words.BATCH_BROUGHT, "", "", figure(brought)))
    return Table(
        words.BATCHES, words.BATCH_COLUMNS, tuple(rows), (0.2, 0.24, 0.32, 0.14, 0.1),
        rest=words.BATCHES_REST, left=(0, 1, 2, 3),
    )  # fmt: skip


def _changed_later(facts: _Facts) -> list[str]:
    """Return what was taken back and corrected, as the log says; why, where it cannot be read."""
    try:
        log = facts.season.log()
    except FieldmonError as changed:
        return [str(changed)]
    return [*changed_later(log, local_clock(facts.season.plot.field), facts.units)]


def _counts(one: Batch, kind: str, said: BatchContents | None) -> str:
    """Return what a batch is, and whether it counts."""
    if one.undone:
        return worded(words.BATCH_UNDONE, kind=kind)
    if said is not None and one.stands_back(said):
        why = words.BATCH_CORRECTED if said.corrected else words.BATCH_ELSEWHERE
        return worded(why, kind=kind)
    if said is not None and one.kind == "findings" and said.counting < one.rows:
        return worded(words.BATCH_PART, kind=kind, n=said.counting)
    return kind


def _treatments(facts: _Facts) -> Block:
    kept = [one for one in facts.season.treatments() if one.day <= facts.status.day]
    if not kept:
        return Listing(words.TREATMENTS, (words.TREATMENTS_NONE,))
    (table,) = treatment_table(kept, facts.season.labels(), facts.season.plot.grid, facts.units)
    return table
