"""What was recorded, a line for each batch: when, from where, what it said and by whom."""

from __future__ import annotations

from datetime import datetime
from typing import TYPE_CHECKING

from fieldmon.compute.wording import Worded, share_figure
from fieldmon.infestation.inspections import RESULT_CODES

from ..words import texts
from ..words.language import in_words, number

if TYPE_CHECKING:
    from fieldmon.monitoring.inspecting.batches import Batch, BatchContents

    from ..state.choices import Choices

#: in `RESULTS_OF`: of a plant that could not be inspected as it is not there any more
GONE = 3


def in_short(result: str) -> str:
    """Return the result of an inspection, as a season's file names it, in a word."""
    known = result in RESULT_CODES  # another program may have written any
    return texts.HISTORY_RESULTS[RESULT_CODES[result]] if known else texts.isolated(result)


def last(choices: Choices, said: BatchContents) -> str:
    """Return what was said last, of one plant: what an undo beside it takes back."""
    words = texts.SCOUT_LAST if choices.plot.grid.in_rows else texts.SCOUT_LAST_ALONE
    return words.format(row=_row(choices, said), plant=_plant(choices, said), result=_result(said))


def source(name: str) -> str:
    """Return where a batch is from: a way to record in the page's language, else a file's name."""
    return texts.BATCH_SOURCES.get(name, name)


def line(choices: Choices, batch: Batch, said: BatchContents | None) -> str:
    """Return what tells a batch from the others."""
    at = choices.clock.at(datetime.fromisoformat(batch.at))
    parts = [f"{choices.units.said_day(at.date(), choices.on)} {at:%H:%M}"]
    from_ = texts.isolated(source(batch.source)) if batch.source else ""
    if batch.kind == "findings" and said is not None:
        parts += [from_, _what(choices, said)]
    else:
        of = _what(choices, said) if batch.kind == "corrections" and said is not None else ""
        parts.append(texts.BATCHES_SAID[batch.kind].format(source=from_ or of))
        parts.append(of if from_ else "")
    if batch.kind == "treatment" and said is not None:
        parts.append(texts.PLANTS_COUNTED.format(n=said.n))
        if said.efficacy is not None:
            parts.append(texts.BATCH_EFFICACY.format(share=in_words(share_figure(said.efficacy))))
    is_corrected = batch.kind == "corrections"
    # results may be brought days later
    if said is not None and not is_corrected and {said.first, said.last} != {str(at.date())}:
        said_days = choices.units.said_days(said.first, said.last, choices.on)
        treated = batch.kind == "treatment"
        parts.append(said_days if treated else texts.BATCH_OF_DAY.format(days=said_days))
    who = batch.by(said)
    parts += [texts.isolated(who) if who else "", texts.UNDONE if batch.undone else ""]
    if said is not None and batch.stands_back(said):
        parts.append(texts.CORRECTED_SINCE if said.corrected else texts.COUNTS_ELSEWHERE)
    return " · ".join(part for part in parts if part)


def undone(said: str) -> str:
    """Return what the season says it took back, in the current language.

    Without the number of the batch, which only commands need.
    """
    return _unnumbered(said, texts.UNDONE_WHAT)


def counts_again(said: str) -> str:
    """Return what the season says counts again, in the current language, without the number."""
    return _unnumbered(said, texts.AGAIN_WHAT)


def _unnumbered(said: str, words: str) -> str:
    parts = said.parts if isinstance(said, Worded) and said.parts else (said,)
    return " ".join(_one_unnumbered(one, words) for one in parts)


def _one_unnumbered(one: str, words: str) -> str:
    if not isinstance(one, Worded) or not {"batch", "what"} <= one.values.keys():
        return in_words(one)
    blanks = one.values
    what = in_words(blanks["what"])
    if "source" in blanks:
        return texts.UNDONE_FROM.format(what=what, source=texts.isolated(source(blanks["source"])))
    if "product" in blanks:
        return texts.UNDONE_WITH.format(what=what, product=texts.isolated(blanks["product"]))
    return words.format(what=what)


def why_to_ask(choices: Choices, batch: Batch, said: BatchContents | None) -> list[str]:
    """Return why it is asked before a batch is undone: it is somebody's, or another day's."""
    why, who = [], batch.by(said)
    if who:
        why.append(texts.UNDO_ASK_WHO.format(who=texts.isolated(who)))
    if said is not None and {said.first, said.last} != {choices.day}:
        named = choices.units.said_days(said.first, said.last, choices.on)
        here = choices.units.said_day(choices.on)
        why.append(texts.UNDO_ASK_DAY.format(days=named, day=here))
    return why


def _row(choices: Choices, said: BatchContents) -> str:
    """Return the row of the only inspection, with its name if that says more than its number."""
    return choices.plot.grid.line_signs.get(said.row, f"{said.row}")


def _plant(choices: Choices, said: BatchContents) -> str:
    """Return the plant of the only inspection in its row, with the face where it has two."""
    return in_words(said.number_on(choices.plot.grid))


def _result(said: BatchContents) -> str:
    """Return the result of the only inspection, and what was counted."""
    result = texts.RESULTS_OF[GONE] if said.is_gone else in_short(said.result)
    if said.count is None:
        return result
    return texts.RESULT_COUNTED.format(result=result, n=number(said.count, ",g"))


def _what(choices: Choices, said: BatchContents) -> str:
    if said.n > 1:
        return texts.BATCHES_SAID["findings"].format(n=said.n, found=said.found)
    where = texts.TIP_PLANT if choices.plot.grid.in_rows else texts.TIP_ALONE
    note = texts.TIP_STATE.format(state=_result(said))
    return where.format(row=_row(choices, said), plant=_plant(choices, said), note=note)
