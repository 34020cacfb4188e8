"""Each answer about records is drawn where it puts them, and tapped there."""

import numpy as np

from app.show import answers_of_records
from app.show.answers_of_records import PLACES, content
from app.state.tried_answers import TriedAnswer
from fieldmon.infestation.records import Records
from tests.app.chosen import a_plot

PLOT = a_plot()
LONLAT = PLOT.grid.lonlat()[:6]
DAYS = np.full(6, np.datetime64("2026-11-01"))


def answer(name, *, off_deg=0.0, finds=2):
    present = (np.arange(6) < finds).astype(np.int8)
    records = Records.of(LONLAT + off_deg, present, DAYS)
    return TriedAnswer(name, zone="Asia/Jerusalem", records=records, near=0 if off_deg else 6)


def drawn(made, name):
    return next(layer.data for layer in made.layers if layer.id == name)


def test_nothing_to_look_at_is_no_map():
    assert content((), PLOT, dark=False) is None
    assert content((TriedAnswer("EPSG:1"),), PLOT, dark=False) is None


def test_each_answer_lies_at_its_own_place_beside_the_plot():
    answers = (answer("EPSG:2039"), TriedAnswer("EPSG:1"), answer("EPSG:28191", off_deg=0.01))
    made = content(answers, PLOT, dark=False)
    assert [one["t"] for one in made.labels] == ["1", "3"]
    assert len(drawn(made, "answer-dots-0")) == 6
    assert len(drawn(made, "answer-finds-2")) == 2
    assert "boundary" in {layer.id for layer in made.layers}
    assert answers_of_records.tapped(answers, PLACES, 1) == "EPSG:28191"
    assert answers_of_records.tapped(answers, "boundary", 0) is None


def test_answers_that_differ_in_finds_alone_are_rings_of_their_own_and_no_places():
    answers = (answer("count=a"), answer("present=b", finds=4))
    made = content(answers, PLOT, dark=False)
    assert PLACES not in {layer.id for layer in made.layers}
    assert [len(drawn(made, f"answer-finds-{k}")) for k in range(2)] == [2, 4]
    names = [name for part in made.legend for _, _, name in part["items"]]
    assert names == ["1 · count=a", "2 · present=b"]
