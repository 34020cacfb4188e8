"""What the report of the chosen day or season says. No Streamlit in here."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.io.import_report import Severity
from fieldmon.reports.certification import certification_report
from fieldmon.reports.day import DayFacts, day_of_each
from fieldmon.reports.settings_rows import WorkSettings

from ..state import assumptions, cached, chosen_day, widget_memory
from ..words import language

if TYPE_CHECKING:
    from collections.abc import Callable

    from fieldmon.reports.content import Report

    from ..state.choices import Choices

#: the box that says whether a team's day has a page of each
EACH = "report of each"


def of_season(choices: Choices) -> Report:
    """Return the report of the season up to the chosen day."""
    made = cached.season_report(
        choices.key, choices.revision, choices.day, choices.units.of_library, choices.open_season
    )
    return made.said_in(language.for_reports(language.current()))


def for_certifier(choices: Choices) -> Report:
    """Return the record of the season up to the chosen day, for a certifier."""
    made = certification_report([choices.open_season], choices.units.of_library, choices.on)
    return made.said_in(language.for_reports(language.current()))


def of_day(choices: Choices) -> Report:
    """Return the report of the chosen day, in a season or without one.

    Where several work it has a page of each, unless the page of one alone is wanted.
    """
    facts = (_of_plan(choices),) if choices.season is None else choices.day_of_each()
    return _as_wanted(choices)(facts)


def to_come(choices: Choices) -> Callable[[], Report]:
    """Return what makes the report of the chosen day, once it is asked for: it asks no page."""
    made = _as_wanted(choices)
    if choices.season is None:
        facts = (_of_plan(choices),)
        return lambda: made(facts)
    season, on, today, wished = choices.season, choices.on, choices.today, choices.wished
    return lambda: made(DayFacts.each_of_season(season, on, today, wished))


def _as_wanted(choices: Choices) -> Callable[[tuple[DayFacts, ...]], Report]:
    """Return what makes a report of a day of each, with the pages and in the words wanted here."""
    units, of_paper = choices.units.of_library, language.for_reports(language.current())
    alone = None if widget_memory.value(EACH, default=True) else choices.whose_day

    def made(facts: tuple[DayFacts, ...]) -> Report:
        shown = tuple(one for one in facts if one.who == alone) if alone else facts
        return day_of_each(shown or facts, units).said_in(of_paper)

    return made


def _of_plan(choices: Choices) -> DayFacts:
    """Return what the report says of a day that no season keeps."""
    shown, grid = chosen_day.route(choices), choices.plot.grid
    said = (one.message for one in choices.messages)
    settings = WorkSettings(
        choices.robot, choices.sampler, choices.prior, (grid.row_spacing_m, grid.plant_spacing_m),
        assumptions.of(choices),
        guessed=tuple(one.sentence for one in said if one.severity is Severity.GUESSED),
        chosen=choices.plot.chosen,
    )  # fmt: skip
    return DayFacts(
        choices.plot.field.name, shown.begins, shown.route, chosen_day.chance(choices),
        chosen_day.states(choices), chosen_day.hot_spots(choices), settings, 0,
        chosen_day.found(choices), day=choices.on,
    )  # fmt: skip
