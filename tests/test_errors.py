"""Problems are told apart by what a caller can do, and come out of other processes as they were."""

import inspect
import pickle
import warnings

import pytest

from fieldmon import errors
from fieldmon.errors import ChoiceNeeded, FieldmonError, ImportDoubt

PROBLEMS = [
    kind for _, kind in inspect.getmembers(errors, inspect.isclass)
    if issubclass(kind, Exception) and kind is not ImportDoubt
]  # fmt: skip


@pytest.mark.parametrize("kind", PROBLEMS)
def test_every_problem_is_caught_as_one_and_says_its_sentence(kind):
    problem = kind("There is none.", "crs") if kind is ChoiceNeeded else kind("There is none.")
    assert isinstance(problem, FieldmonError)
    assert str(problem) == "There is none."


@pytest.mark.parametrize("kind", PROBLEMS)
def test_a_problem_in_a_working_process_is_the_same_here(kind):
    more = ("layer", ("a", "b"), "plot") if kind is ChoiceNeeded else ()
    problem = kind("Choose one.", *more)
    again = pickle.loads(pickle.dumps(problem))  # noqa: S301 - our own
    assert type(again) is kind
    assert str(again) == "Choose one."
    assert vars(again) == vars(problem)


def test_a_question_knows_its_option_its_answers_and_the_file_that_asks():
    asked = ChoiceNeeded("Which layer?", "layer", ("plots", "roads"), role="paths")
    assert (asked.option, asked.choices, asked.role) == ("layer", ("plots", "roads"), "paths")
    assert ChoiceNeeded("Which system?", "crs").choices == ()


def test_a_doubt_of_an_import_is_a_warning_and_stops_nobody():
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        warnings.warn("It was guessed.", ImportDoubt, stacklevel=1)
    assert [warning.category for warning in heard] == [ImportDoubt]
    assert not issubclass(ImportDoubt, FieldmonError)
