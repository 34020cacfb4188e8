"""Results that are recorded, whichever form, file or page they are from, and what is said of it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.errors import ContradictionError
from fieldmon.infestation.inspections import SKIPPED
from fieldmon.io.parse import result_words
from fieldmon.monitoring.season import season_inspections
from fieldmon.plot.local_clock import local_clock

from ..show import cautions
from ..show.recorded_batches import GONE
from ..state import notices, unconfirmed
from ..state.fresh_boxes import FreshBoxes
from ..state.unconfirmed import Unconfirmed
from ..words import texts
from ..words.language import in_words

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from fieldmon.infestation.inspections import Inspections
    from fieldmon.io.import_report import ImportMessage
    from fieldmon.monitoring.inspecting.batches import Recorded

    from ..state.choices import Choices


def as_kept(result: int) -> tuple[int, str]:
    """Return a result as a season keeps it, with its note."""
    return (SKIPPED, result_words.GONE) if result == GONE else (result, "")


def warn_of_lost(messages: Iterable[ImportMessage]) -> None:
    """Let what is returned be no success where something of a file was left out or is doubtful."""
    if any(message.severity.is_loss for message in messages):
        notices.warn()


def listed(sentences: Iterable[str]) -> str:
    """Return what was said of a file, a line for each sentence."""
    return "".join(f"\n- {in_words(sentence)}" for sentence in sentences)


def recorded(
    choices: Choices, results: Inspections, source: str, form: str = "",
    messages: tuple[ImportMessage, ...] = (), who: str = "",
) -> Recorded | None:  # fmt: skip
    """Record results, and empty the form that they are from; `who` inspected, unless they say so.

    None where some contradict what is recorded: they wait for a word on it, and what was said of
    their file waits with them.
    """
    try:
        done = season_inspections.recorded(choices.open_season, results, source, who)
    except ContradictionError:
        of = choices.key, choices.day
        unconfirmed.keep(Unconfirmed(*of, results, source, form, messages, who))
        return None
    unconfirmed.drop()
    if form:
        FreshBoxes(form, choices).empty()
    return done


def said_of(choices: Choices, done: Recorded | None, results: Inspections | None = None) -> str:
    """Return what recording did, and of which days if not of that shown.

    Nothing where results wait for a word.
    """
    if done is None:
        return ""
    corrected: list[str] = [texts.CORRECTED.format(n=done.corrected)] if done.corrected else []
    if done.new or done.known or not corrected:
        said = [texts.RECORDED.format(new=done.new, known=done.known)]
        more = (
            *((texts.NOTED, done.noted), (texts.COMPLETED, done.filled)),
            (texts.BY_A_SECOND, done.seen_by_another),
        )
        corrected.append(" ".join([*said, *(text.format(n=n) for text, n in more if n)]))
    if results is not None:
        corrected += _of_days(choices, results)
    return "\n\n".join(corrected)


def _of_days(choices: Choices, results: Inspections) -> Iterator[str]:
    """Yield of which days results are, if not of that shown, and that one has not come."""
    days = results.date[~np.isnat(results.date)]
    if not len(days):
        return
    first, last = days.min().item(), days.max().item()
    # past midnight the page is about the next day already
    shown = local_clock(choices.plot.field).today() if choices.is_today else choices.on
    if {first, last} != {shown}:
        said = choices.units.said_days(first, last, shown)
        day = choices.units.said_day(shown)
        yield texts.RECORDED_OF.format(days=said, day=day)
    if ahead := cautions.not_come(choices, last):
        notices.warn()
        yield ahead
