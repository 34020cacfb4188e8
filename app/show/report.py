"""What the report of the chosen day or season says. No Streamlit in here."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.infestation.prior import PriorSettings
from fieldmon.io.import_report import Severity
from fieldmon.monitoring import day_was_worked
from fieldmon.reports.day import DayFacts, day_report
from fieldmon.reports.settings_rows import WorkSettings

from ..state import cached, chosen_day

if TYPE_CHECKING:
    from fieldmon.reports.content import Report

    from ..state.choices import Choices


def of_season(choices: Choices) -> Report:
    """Return the report of the season up to the chosen day."""
    return cached.season_report(
        choices.key, choices.revision, choices.day, choices.units, choices.season
    )


def of_day(choices: Choices) -> Report:
    """Return the report of the chosen day, in a season or without one."""
    season, shown = choices.season, chosen_day.route(choices)
    inspected = 0 if season is None else chosen_day.progress(choices).inspected_today
    facts = DayFacts(
        choices.plot.field.name, shown.begins, shown.route, chosen_day.chance(choices),
        chosen_day.states(choices), chosen_day.hot_spots(choices), _settings(choices), inspected,
        chosen_day.found(choices),
        season is not None and day_was_worked(season, choices.on, choices.plan().route),
    )  # fmt: skip
    return day_report(facts, choices.units)


def _settings(choices: Choices) -> WorkSettings:
    season = choices.season
    if season is None:
        said = (one.message for one in choices.messages)
        guessed = tuple(one.sentence for one in said if one.severity is Severity.GUESSED)
        return WorkSettings(choices.robot, choices.sampler, PriorSettings(), guessed=guessed)
    messages = cached.import_messages(choices.key, season)
    return WorkSettings.of_season(season.settings, messages)
