"""A day on one page: what to do or what was done, where, stop by stop, and by what settings."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from datetime import datetime, timedelta
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import (
    chance_figure,
    estimate,
    figure,
    hours_figure,
    joined,
    runs,
    worded,
)
from fieldmon.infestation.inspections import FOUND
from fieldmon.infestation.records import PRESENT, UNKNOWN
from fieldmon.monitoring import day_was_worked, worked_route
from fieldmon.monitoring.changes.earlier_settings import settings_on
from fieldmon.monitoring.days.day_ahead import WorkPart, plan_ahead
from fieldmon.monitoring.days.worked_route import past_midnight
from fieldmon.monitoring.estimates.last_days import default_date
from fieldmon.monitoring.estimates.plant_states import hot_spots_on, not_inspected, shown_apart
from fieldmon.monitoring.inspecting.contradictions import contradiction_lines
from fieldmon.monitoring.settings.shift_work import made_by
from fieldmon.monitoring.treating.cautions import label_of, waits
from fieldmon.monitoring.treating.closures import closed_in_words
from fieldmon.planning.members import person_key
from fieldmon.planning.skips import left_out_in_words
from fieldmon.plot.grid import plant_numbers
from fieldmon.plot.local_clock import grid_clock
from fieldmon.reports import maps, words
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
    TickList,
)
from fieldmon.reports.maps import PlotMap
from fieldmon.reports.sentences import headline
from fieldmon.reports.settings_rows import WorkSettings, assumed_sentence, settings_blocks

if TYPE_CHECKING:
    from collections.abc import Sequence
    from datetime import date

    from numpy.typing import NDArray

    from fieldmon.compute.units import Units
    from fieldmon.compute.wording import Worded
    from fieldmon.decisions.labels import ProductLabel
    from fieldmon.infestation.hotspots import HotSpots
    from fieldmon.monitoring import PlannedAndDone, Season
    from fieldmon.monitoring.estimates.history import History
    from fieldmon.monitoring.treating.closures import Closure
    from fieldmon.monitoring.treating.treatments import KeptTreatment
    from fieldmon.planning.route import Route
    from fieldmon.planning.wishes import Wishes
    from fieldmon.plot.grid import PlantGrid

#: stands where plants have no row, a stop no time, or somebody no name
NO_ROW = "–"
# of more rows, three tables stand side by side instead of two
_MOST_WIDE = 24
# as many letters as a column has room for, in two tables and in three
_WHICH = {2: 40, 3: 22}
# so many rows with finds all have room; of a day that was worked the map is worth more
_MOST_FOUND = 36
# more do not fit a page beside the rest of a day
_MOST_OTHERWISE = 10
_MAP_MM = {False: 80.0, True: 120.0}


@dataclass(frozen=True, eq=False)
class DayFacts:
    """All that a day's report says.

    Parameters
    ----------
    name
        The plot's name.
    begins
        Local time at which the route begins.
    route
        The route as planned or, if `worked`, as it was worked.
    chance, state
        ``(n,)`` what is believed, and found (1), clean (0) or never inspected (-1).
    spots
        Where finds cluster.
    settings
        What the day goes by.
    inspected
        Plants inspected that day so far.
    found
        ``(k,)`` plants found infested that day, by number.
    worked
        Whether the day is over.
    results
        Result of each plant inspected that day, by its number.
    held
        The plan kept of the day, held to what was done; None: none was kept.
    who
        Whose route it is, of a team; empty: that of all who work.
    team
        Names of those whose results are shown together, of a team or with codes of their own.
        Nobody went from one to the next: no times are said, and no way is drawn.
    missed
        Whether the day is past, and no inspection of it was recorded: its route is not shown.
    treatments, labels
        What was treated that day, and what labels allow.
    infested
        How many plants of the route are believed infested, those where it hides among them; None:
        nothing is known to hide.
    closed
        Plants that are left off the route as people may not be there yet.
    skipped
        How many are left out because nobody could inspect them.
    recorded
        ``(n,)`` other finds, which only the records of before a season tell of; None: none.
    passed
        ``(n,)`` plants never seen that could not be inspected, or are gone; None: none.
    otherwise
        Who says what of each plant that was both clean and found that day.
    past_midnight
        How many plants were inspected after midnight in the shift of that day, and found infested
        of these: they are dated the next day, and not among `inspected` and `found`.
    before
        How many of those inspected that day were so in the shift of the day before.
    day
        The day; None: that on which the route begins. What is left of a shift may begin after
        midnight.
    """

    name: str
    begins: datetime
    route: Route
    chance: NDArray[np.float64]
    state: NDArray[np.int8]
    spots: HotSpots
    settings: WorkSettings
    inspected: int = 0
    found: NDArray[np.integer] = field(default_factory=lambda: np.empty(0, np.int32))
    worked: bool = False
    results: dict[int, int] = field(default_factory=dict)
    held: PlannedAndDone | None = None
    who: str = ""
    team: tuple[str, ...] = ()
    missed: bool = False
    treatments: tuple[KeptTreatment, ...] = ()
    labels: tuple[ProductLabel, ...] = ()
    infested: float | None = None
    closed: tuple[Closure, ...] = ()
    skipped: tuple[Worded, ...] = ()
    recorded: NDArray[np.bool_] | None = None
    passed: NDArray[np.bool_] | None = None
    otherwise: tuple[Worded, ...] = ()
    past_midnight: tuple[int, int] = (0, 0)
    before: int = 0
    day: date | None = None

    @property
    def is_idle(self) -> bool:
        """Return whether it is of one for whom stops were planned, and nothing was recorded."""
        return bool(self.who and self.held is not None and self.held.left and not self.results)

    @property
    def on(self) -> date:
        """The day that it is about."""
        return self.begins.date() if self.day is None else self.day

    @classmethod
    def of_season(
        cls, season: Season, on: date, today: date | None = None, who: str | None = None,
        wished: tuple[Wishes | None, bool] = (None, False),
    ) -> DayFacts:  # fmt: skip
        """Return what a season knows of a day; nothing is kept by it.

        `today` as in `day_was_worked`. `who` is whose day it is, of several; None: that of all or,
        of a team ahead, of its first. `wished` is what `plan_ahead` takes: `wishes` and `anew`.
        """
        with season.store.one_moment():
            first = "".join([one.name for one in season.planned_by(on).team][:1])
            whose = first if who is None else who
            plan = plan_ahead(season, on, WorkPart(name=whose), wishes=wished[0], anew=wished[1])
            route = plan.route
            told = made_by(season.history.on(season.settings.day(on)), who)
            worked = bool(len(told)) and day_was_worked(season, on, route, today)
            settings = settings_on(season, on) if worked else season.planned_by(on)
            day = settings.day(on)
            shown = worked_route(season, on, who) if worked else route
            begins = datetime.combine(on, settings.starts)
            if shown.notes is not None and shown.notes.start is not None:
                begins = shown.notes.start
            names = tuple(one.name for one in settings.team)
            state, recorded = shown_apart(season.history, day)
            done = told.inspected
            return cls(
                season.plot.field.name, begins,
                shown, season.evening(on), state,
                hot_spots_on(season.history, day),
                WorkSettings.of_season(season, on, worked=worked).with_learnt(season, on),
                len(np.unique(done.plant)), np.unique(done.plant[done.result == FOUND]),
                worked, dict(zip(told.plant.tolist(), told.result.tolist(), strict=True)),
                season.planned_and_done(on, who),
                who=who or ("" if worked else first),
                team=who_came(season, on, names) if worked and who is None else (),
                missed=was_missed(season, on, today),
                treatments=treated_on(season, on), labels=season.labels(),
                infested=float(season.evening(on)[shown.plant].sum()),
                closed=() if worked else season.closed(on, whose, plan.scene.seconds_left),
                skipped=() if worked else left_out_in_words(plan.scene, route),
                recorded=recorded, passed=passed_by(season.history, day, state),
                otherwise=contradiction_lines(
                    season.inspections.on(on), season.plot.grid, words.isolated
                ),
                past_midnight=plants_past_midnight(season, on, who),
                before=plants_past_midnight(season, on - timedelta(days=1), who)[0],
                day=on,
            )  # fmt: skip

    @classmethod
    def each_of_season(
        cls, season: Season, on: date, today: date | None = None,
        wished: tuple[Wishes | None, bool] = (None, False),
    ) -> tuple[DayFacts, ...]:  # fmt: skip
        """Return a day as `of_season` does and, where several work, that of each of them.

        Of a day ahead that of each alone: no route is that of all.
        """
        with season.store.one_moment():
            whole = cls.of_season(season, on, today, None, wished)
            team = tuple(one.name for one in season.planned_by(on).team)
            came = {person_key(name): name for name in whole.team if name != NO_ROW}
            out = {person_key(name): name for name in team} | came
            if whole.missed or len(out) < 2:
                return (whole,)
            is_over = on < default_date(season) or (today is not None and on < today)
            each = [cls.of_season(season, on, today, name, wished) for name in out.values()]
            shows = [one.worked or (len(one.route) > 0 and not is_over) for one in each]
            shown = [
                one if has else replace(one, missed=True)
                for one, has in zip(each, shows, strict=True)
                if has or one.is_idle
            ]
            together = [whole] if whole.worked or not shown else []
            return (*together, *shown)


def plants_past_midnight(season: Season, on: date, who: str | None = None) -> tuple[int, int]:
    """Return how many plants were inspected after midnight in a day's shift, and found of these.

    By one of several; None: by all.
    """
    done = made_by(past_midnight(season, on), who).inspected
    return len(np.unique(done.plant)), len(np.unique(done.plant[done.result == FOUND]))


def was_missed(season: Season, on: date, today: date | None) -> bool:
    """Return whether a day is past and no inspection of it was recorded; `today` None: it is not.

    What is past is told by the plot's calendar.
    """
    passed = today is not None and on < today
    return passed and not len(season.history.on(season.settings.day(on)))


def treated_on(season: Season, on: date) -> tuple[KeptTreatment, ...]:
    """Return the treatments of a day."""
    return tuple(one for one in season.treatments() if one.on == on)


def who_came(season: Season, on: date, team: tuple[str, ...] = ()) -> tuple[str, ...]:
    """Return who inspected on a day, if several did or there is a `team`; else nobody.

    Whoever is named nowhere is one of several.
    """
    who = season.history.inspections.on(on).inspected.who
    came = {person_key(str(name)): str(name) for name in who}
    if not team and len(came) < 2:
        return ()
    named = sorted(name for name in came.values() if name)
    unnamed = [NO_ROW] if "" in came and not team else []
    return (*named, *unnamed) or team


def results_on(season: Season, on: date) -> dict[int, int]:
    """Return what was last noted of each plant that somebody stood before on a day."""
    done = season.history.on(season.settings.day(on))
    return dict(zip(done.plant.tolist(), done.result.tolist(), strict=True))


def day_report(facts: DayFacts, units: Units) -> Report:
    """Return the report of a day."""
    title = worded(words.DAY_TITLE, day=units.day(facts.on))
    return Report(facts.name, title, facts.on, (_sheet(facts, units, words.DAY_SHEET),))


def day_of_each(each: Sequence[DayFacts], units: Units) -> Report:
    """Return the report of a day with a page of each of several who work, see `each_of_season`."""
    sheets = tuple(
        _sheet(
            one, units,
            worded(words.DAY_SHEET_OF, who=words.isolated(one.who)) if one.who else words.DAY_SHEET,
        )
        for one in each
    )  # fmt: skip
    return replace(day_report(each[0], units), sheets=sheets)


def _sheet(facts: DayFacts, units: Units, heading: str) -> Sheet:
    blocks: list[Block] = [
        *(Paragraph(said, lead=True) for said in _leads(facts, units)),
        *([] if facts.missed else [_figures(facts, units)]),
        *_otherwise(facts),
        *(Paragraph(said) for said in [assumed_sentence(facts.settings, units)] if said),
        *treatment_table(facts.treatments, facts.labels, facts.route.aisles.grid, units),
        *_map(facts, units),
    ]
    has_route = len(facts.route) and not facts.missed
    if has_route:
        blocks.append(_stops(facts))
    if len(facts.found):
        blocks.append(_found(facts))
    blocks += settings_blocks(facts.settings, units)
    if not facts.worked:  # what was noted then is in the season
        blocks.append(NoteLines(words.NOTES))
    if has_route:
        blocks.append(_every_stop(facts))
    return Sheet(heading, tuple(blocks))


def _leads(facts: DayFacts, units: Units) -> list[str]:
    day = units.day(facts.on)
    if facts.missed:
        planned = 0 if facts.held is None else facts.held.planned
        of_plan = [worded(words.MISSED_PLAN, planned=planned)] * bool(planned)
        if facts.is_idle and facts.held is not None:
            held = worded(words.PLANNED_DONE, **held_in_words([facts.held]))
            return [worded(words.MISSED_OF, who=words.isolated(facts.who)), held]
        return [worded(words.MISSED, day=day), *of_plan]
    said: list[str] = []
    if facts.inspected:
        numbers = {"inspected": facts.inspected, "found": len(facts.found)}
        said += [worded(words.WORKED, day=day, **numbers), *_other_shifts(facts, units)]
        if facts.held is not None:
            held = worded(words.PLANNED_DONE, **held_in_words([facts.held]))
            if facts.before or facts.past_midnight[0]:
                held = joined(" ", (worded(words.OF_SHIFT, day=day), held))
            said.append(held)
    if not (facts.worked and said):
        said.append(headline(facts.route, day))
    if facts.who:
        said.append(worded(words.DAY_OF, who=words.isolated(facts.who)))
    elif not (facts.worked or facts.team or facts.held is None) and facts.held.people > 1:
        said.append(worded(words.DAY_OF_NOBODY))
    if not facts.worked:
        grid = facts.route.aisles.grid
        said += closed_in_words(facts.closed, grid, units)
        said += facts.skipped
    return said


def _other_shifts(facts: DayFacts, units: Units) -> list[str]:
    """Return what is of another date than its shift: a plan is of a shift, results of a date."""
    on, said = facts.on, list[str]()
    if facts.before:
        day = units.day(on - timedelta(days=1))
        said.append(worded(words.OF_SHIFT_BEFORE, day=day, n=facts.before))
    inspected, found = facts.past_midnight
    if inspected:
        following = units.day(on + timedelta(days=1))
        of_shift = {"day": units.day(on), "inspected": inspected, "found": found}
        said.append(worded(words.PAST_MIDNIGHT, next=following, **of_shift))
    return said


def _otherwise(facts: DayFacts) -> list[Listing]:
    said = facts.otherwise[:_MOST_OTHERWISE]
    if (more := len(facts.otherwise) - len(said)) > 0:
        said = (*said, worded(words.REST, n=more))
    return [Listing(words.OTHERWISE, said)] if said else []


def held_in_words(held: Sequence[PlannedAndDone]) -> dict[str, int]:
    """Return what plans came to altogether, for a sentence."""
    names = ("planned", "done", "left", "added")
    return {name: sum(getattr(one, name) for one in held) for name in names}


def _figures(facts: DayFacts, units: Units) -> KeyFigures:
    route, n = facts.route, len(facts.chance)
    inspected = KeyFigure(
        words.INSPECTED if facts.worked else words.PLANTS_TO_INSPECT,
        # a plant that was come to twice is one
        figure(len(np.unique(route.plant))), worded(words.OF_PLANTS, n=n),
    )  # fmt: skip
    pause_s = _between_shifts_s(facts)
    hours: str = worded(words.FROM_TO, start=_clock(facts, 0.0), end=_clock(facts, route.end_s))
    hours = hours if len(route) and not pause_s else ""
    ahead = KeyFigure(
        words.FINDS, estimate(route.expected_finds), _of_infested(facts),
    )  # fmt: skip
    done = KeyFigure(
        words.FOUND_TODAY, figure(len(facts.found)), worded(words.OF_INSPECTED, n=facts.inspected)
    )
    if facts.team:
        names = ", ".join(map(words.isolated, facts.team))
        together = KeyFigure(words.TEAM, figure(len(facts.team)), names)
        return KeyFigures((replace(inspected, value=figure(facts.inspected)), together, done))
    return KeyFigures(
        (
            inspected,
            KeyFigure(words.TIME, hours_figure((route.end_s - pause_s) / 3600), hours),
            KeyFigure(words.DRIVE, units.metres(route.drive_m)),
            done if facts.worked else ahead,
        )
    )  # fmt: skip


def _between_shifts_s(facts: DayFacts) -> float:
    """Return how long nobody worked between two shifts of one date; 0: one alone was worked."""
    arrive_s = facts.route.arrive_s
    is_of_two = facts.worked and 0 < facts.before < facts.inspected and len(arrive_s) > 1
    return float(np.diff(arrive_s).max()) if is_of_two else 0.0


def _of_infested(facts: DayFacts) -> str:
    """Return of how many infested plants the finds are; where it hides in some, how many show."""
    seen = estimate(facts.route.expected_visible)
    n = seen if facts.infested is None else estimate(facts.infested)
    return worded(words.OF_INFESTED if n == seen else words.OF_HIDDEN, n=n, seen=seen)


def _map(facts: DayFacts, units: Units) -> list[Block]:
    grid = facts.route.aisles.grid
    way = None if facts.team or facts.missed else facts.route
    what = PlotMap(grid, facts.chance, facts.state, facts.spots, facts.route.aisles.gate_m, units,
                   way, recorded=facts.recorded, passed=facts.passed)  # fmt: skip
    alt = map_alt(facts.name, facts.state, 0 if facts.missed else len(facts.route))
    return [
        Illustration("", alt, what.draw, what.heights(_MAP_MM[facts.worked], 190.0)),
        legend_block(
            route=way is not None, recorded=is_any(facts.recorded), passed=is_any(facts.passed)
        ),
    ]


def map_alt(name: str, state: NDArray[np.int8], stops: int) -> str:
    """Return what a map shows, in words."""
    finds = int(np.count_nonzero(state == PRESENT))
    return worded(
        words.MAP_ALT, name=words.isolated(name), plants=len(state), stops=stops, finds=finds
    )


def passed_by(history: History, day: int, state: NDArray[np.int8]) -> NDArray[np.bool_]:
    """Return ``(n,)`` plants never seen, by `state`, that could not be inspected, or are gone."""
    passed: NDArray[np.bool_] = (state == UNKNOWN) & (not_inspected(history, day) > 0)
    return passed


def is_any(signed: NDArray[np.bool_] | None) -> bool:
    """Return whether a map has plants with a sign: finds of records alone, or plants passed by."""
    return signed is not None and bool(signed.any())


def legend_block(**signs: bool) -> Illustration:
    """Return the legend below a map, with those of the signs of `maps.legend` that it has."""
    high = maps.legend_mm(passed=signs.get("passed", False))
    return Illustration(
        "", "",
        lambda size: maps.legend(size[0], **signs),
        (high, high), is_read=True,
    )  # fmt: skip


def _stops(facts: DayFacts) -> Table:
    """Return the rows in the order in which they are come to, with their plants.

    Nobody came to those of several together in one order: these are by row.
    """
    grid = facts.route.aisles.grid
    numbered = plant_numbers(grid, facts.route.plant)
    lines, first = np.unique(numbered.line, return_index=True)
    rows, flow = [], 2 if len(lines) <= _MOST_WIDE else 3
    by = 0 if facts.team else 1
    each = zip(lines.tolist(), first.tolist(), strict=True)
    for line, k in sorted(each, key=lambda one: one[by]):
        own = np.unique(numbered.number[numbered.line == line]).tolist()  # come to twice is one
        rows.append(
            (
                grid.line_signs[line] if grid.in_rows else NO_ROW,
                _clock(facts, facts.route.arrive_s[k]),
                f"{len(own)}",
                which(own, _WHICH[flow]),
            )
        )
    return Table(
        words.STOPS_BY_ROW if facts.team else words.STOPS, words.STOPS_COLUMNS, tuple(rows),
        (0.15, 0.16, 0.17, 0.52), flow=flow, rest=words.STOPS_REST, left=(3,),
    )  # fmt: skip


def which(numbers: list[int], letters: int) -> str:
    """Return which plants of a row these are, in about so many letters at most."""
    said = runs(numbers)
    if len(said) <= letters:
        return said
    return worded(words.WHICH_MANY, n=len(numbers), low=min(numbers), high=max(numbers))


def treatment_table(
    treatments: Sequence[KeptTreatment],
    labels: Sequence[ProductLabel],
    grid: PlantGrid,
    units: Units,
) -> list[Table]:
    """Return what was treated, the last first, as a table; none of nothing."""
    rows = []
    for one in reversed(treatments):
        first = waits(one, label_of(one, labels)).harvest_from
        rows.append(
            (
                units.day(one.on),
                one.application.product,
                figure(int(np.count_nonzero(grid.vines_of(one.place.plants)))),
                figure(one.efficacy, ".0%"),
                words.CERT_NOT_SAID if first is None else units.day(first),
            )
        )
    table = Table(
        words.TREATMENTS, words.TREATMENT_COLUMNS, tuple(rows), (0.18, 0.34, 0.14, 0.14, 0.2),
        rest=words.EARLIER_REST, left=(0, 1),
    )  # fmt: skip
    return [table] if rows else []


def _found(facts: DayFacts) -> Table:
    grid = facts.route.aisles.grid
    numbered = plant_numbers(grid, facts.found)
    rows = tuple(
        (
            grid.line_signs[line] if grid.in_rows else NO_ROW,
            runs(numbered.number[numbered.line == line].tolist()),
        )
        for line in np.unique(numbered.line).tolist()
    )
    return Table(
        words.FOUND_BY_ROW, words.FOUND_COLUMNS, rows, (0.2, 0.8), flow=3, rest=words.FOUND_REST,
        left=(1,), whole=facts.worked and len(rows) <= _MOST_FOUND,
    )  # fmt: skip


def _every_stop(facts: DayFacts) -> TickList:
    """Return every stop with a box to tick or, once the day is over, with its result."""
    route, signs = facts.route, facts.route.aisles.grid.line_signs
    numbered = plant_numbers(route.aisles.grid, route.plant)
    said = [
        words.RESULTS[facts.results.get(plant, -1)] if facts.worked else "☐"
        for plant in route.plant.tolist()
    ]
    rows = zip(
        range(1, len(route) + 1), route.arrive_s.tolist(), numbered.line.tolist(),
        numbered.number.tolist(), route.believed.tolist(), said, strict=True,
    )  # fmt: skip
    return TickList(
        words.EVERY_STOP, (*words.EVERY_COLUMNS, words.WAS if facts.worked else words.TICK),
        tuple(
            (
                f"{k}", _clock(facts, s, "%H:%M:%S"), signs[line], f"{number}",
                chance_figure(chance, 1), end,
            )
            for k, s, line, number, chance, end in rows
        ),
    )  # fmt: skip


def _clock(facts: DayFacts, seconds: float, form: str = "%H:%M") -> str:
    if facts.team:
        return NO_ROW
    if facts.worked:  # from one time noted to another
        return (facts.begins + timedelta(seconds=round(seconds))).strftime(form)
    clock = grid_clock(facts.route.aisles.grid)
    return clock.after(facts.begins, round(seconds)).strftime(form)
