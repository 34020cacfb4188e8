"""Answering what a plot's file leaves open: by its sentence, by buttons, and on the map."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from fieldmon.errors import ChoiceNeeded

from ..show import answers_map, answers_of_records, field_map
from ..show.map_view import MapAnswers
from ..state import brought_files, browser
from ..state.tried_answers import tried, tried_of_records
from . import bringing_files

if TYPE_CHECKING:
    from fieldmon.errors import FieldmonError

    from ..show.map_view import MapContent
    from ..state.brought_files import LeftOut
    from ..state.choices import Choices
    from ..state.tried_answers import TriedAnswer

# what asks where on earth a plot is
_ON_EARTH = frozenset({"crs", "swap_axes"})


def show(problem: FieldmonError) -> None:
    """Say a problem; where it is a question, try each answer and draw what it leads to."""
    answers = tried(problem)
    bringing_files.say(problem, tried=answers)
    on_earth = isinstance(problem, ChoiceNeeded) and problem.option in _ON_EARTH
    looked_at = answers_map.content(answers, dark=browser.is_dark(), on_earth=on_earth)
    if looked_at is not None:
        field_map.want(looked_at, MapAnswers(tapped=partial(take, problem, answers)))


def of_records(choices: Choices) -> tuple[MapContent, MapAnswers] | None:
    """Return the map of what answers to a question about records lead to; None: none is asked."""
    for one in choices.left_out:
        answers = tried_of_records(one, choices.plot.field)
        looked_at = answers_of_records.content(answers, choices.plot, dark=choices.dark)
        if looked_at is not None:
            return looked_at, MapAnswers(tapped=partial(_take_of_records, one, answers))
    return None


def _take_of_records(
    left_out: LeftOut, answers: tuple[TriedAnswer, ...], layer: str, n: int
) -> None:
    """Take the answer about records that was tapped on the map."""
    answer, problem = answers_of_records.tapped(answers, layer, n), left_out.problem
    if isinstance(problem, ChoiceNeeded) and answer is not None:
        brought_files.answer(left_out.file.asked, problem.option, answer)


def take(problem: FieldmonError, answers: tuple[TriedAnswer, ...], layer: str, n: int) -> None:
    """Take the answer that was tapped on the map."""
    answer = answers_map.tapped(answers, layer, n)
    if isinstance(problem, ChoiceNeeded) and answer is not None:
        brought_files.answer(brought_files.asking(), problem.option, answer)
