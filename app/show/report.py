"""What the report of the chosen day or season says. No Streamlit in here."""

from __future__ import annotations

from dataclasses import replace
from datetime import timedelta
from typing import TYPE_CHECKING

from fieldmon.io.import_report import Severity
from fieldmon.monitoring.inspecting.contradictions import contradiction_lines
from fieldmon.reports import words
from fieldmon.reports.certification import certification_report
from fieldmon.reports.day import (
    DayFacts,
    day_report,
    plants_past_midnight,
    results_on,
    treated_on,
    was_missed,
    who_came,
)
from fieldmon.reports.settings_rows import WorkSettings

from ..state import assumptions, cached, chosen_day
from ..words import language

if TYPE_CHECKING:
    from collections.abc import Callable
    from datetime import date

    from fieldmon.monitoring import Season
    from fieldmon.reports.content import Report

    from ..state.choices import Choices


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
    """Return the report of the chosen day, in a season or without one."""
    return to_come(choices)()


def to_come(choices: Choices) -> Callable[[], Report]:
    """Return what makes the report of the chosen day, once it is asked for: it asks no page."""
    season, shown, who = choices.season, chosen_day.route(choices), choices.whose_day or ""
    state, recorded = chosen_day.states_apart(choices)
    facts = DayFacts(
        choices.plot.field.name, shown.begins, shown.route, chosen_day.chance(choices),
        state, chosen_day.hot_spots(choices),
        _settings(choices, worked=shown.worked),
        0 if season is None else chosen_day.progress(choices).inspected_today,
        chosen_day.found(choices), shown.worked,
        {} if season is None else results_on(season, choices.on),
        None if season is None else season.planned_and_done(choices.on),
        who=who,
        team=who_came(season, choices.on) if season and shown.worked and not who else (),
        missed=season is not None and was_missed(season, choices.on, choices.today),
        treatments=() if season is None else treated_on(season, choices.on),
        labels=() if season is None else season.labels(),
        recorded=recorded,
        otherwise=() if season is None else contradiction_lines(
            season.inspections.on(choices.on), season.plot.grid, words.isolated
        ),
        day=choices.on,
        past_midnight=(0, 0) if season is None else plants_past_midnight(season, choices.on),
        before=0 if season is None
        else plants_past_midnight(season, choices.on - timedelta(days=1))[0],
    )  # fmt: skip
    units, of_paper = choices.units.of_library, language.for_reports(language.current())
    on = choices.on
    return lambda: day_report(_with_estimates(facts, season, on), units).said_in(of_paper)


def _with_estimates(facts: DayFacts, season: Season | None, on: date) -> DayFacts:
    """Return facts with what takes a while: how many are infested, what inspections detect."""
    if season is None:
        return facts
    infested = float(season.evening(on)[facts.route.plant].sum())
    return replace(facts, infested=infested, settings=facts.settings.with_learnt(season, on))


def _settings(choices: Choices, *, worked: bool) -> WorkSettings:
    if choices.season is not None:
        return WorkSettings.of_season(choices.season, choices.on, worked=worked)
    grid, said = choices.plot.grid, (one.message for one in choices.messages)
    return WorkSettings(
        choices.robot, choices.sampler, choices.prior, (grid.row_spacing_m, grid.plant_spacing_m),
        assumptions.of(choices),
        guessed=tuple(one.sentence for one in said if one.severity is Severity.GUESSED),
        chosen=choices.plot.chosen,
    )  # fmt: skip
