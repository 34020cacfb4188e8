"""Sentences that remember their words, and numbers of things as they are said."""

import pickle

import numpy as np
import pytest

from fieldmon.compute.wording import Worded, counted, filled, first_few, runs, worded


@pytest.mark.parametrize(
    ("number", "said"), [(0, "0 plants"), (1, "1 plant"), (2, "2 plants"), (1320, "1,320 plants")]
)
def test_one_thing_stands_alone_and_any_other_number_is_several(number, said):
    assert counted(number, "plant") == said


@pytest.mark.parametrize(("n", "said"), [(1, "1 record lies"), (3, "3 records lie")])
@pytest.mark.parametrize("kind", [int, np.int64, np.uint8, float])
def test_words_for_one_or_more_are_chosen_by_any_kind_of_number(kind, n, said):
    assert filled("{n:,.0f} {n:record lies|records lie}", {"n": kind(n)}) == said


def test_a_worded_sentence_is_the_sentence_everywhere_but_remembers_its_words():
    said = worded("{plants} {where}: never inspected yet.", plants=counted(3, "plant"),
                  where=worded("in row {row}", row=7))  # fmt: skip
    assert said == "3 plants in row 7: never inspected yet."
    assert f"{said}" == str(said) == said
    assert isinstance(said, Worded)


def test_worded_sentences_survive_the_way_from_another_process():

    said = pickle.loads(  # noqa: S301 - from here
        pickle.dumps(worded("in row {row}", row=counted(2, "plant")))
    )
    assert (said, said.words, said.values["row"].one) == (
        "in row 2 plants",
        "in row {row}",
        "{n:,} plant",
    )


def test_of_many_names_the_first_are_said_and_that_there_are_more():
    assert first_few(["a", "b"], 2) == "a, b"
    assert first_few(("a", "b", "c"), 2) == "a, b, ..."
    assert first_few([], 2) == ""


@pytest.mark.parametrize(
    ("numbers", "said"),
    [([], ""), ([7], "7"), ([3, 1, 2], "1–3"), ([1, 4, 5, 6, 9, 9], "1, 4–6, 9"), ([1, 2], "1–2")],
)
def test_numbers_in_a_row_are_put_together(numbers, said):
    assert runs(numbers) == said
