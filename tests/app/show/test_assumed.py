"""What is assumed, in words."""

from app.show.assumed import mark, of_who_inspects, sentence
from app.words.units import UnitsInLanguage
from fieldmon.plot.assumed import Assumed
from tests.app.driving import apart

ROWS, KNOWN = Assumed("row_spacing_m", 4.0), Assumed("background_chance", 0.01)


def test_lengths_are_in_the_persons_unit_and_chances_in_percent():
    assert apart(sentence([ROWS, KNOWN], UnitsInLanguage())).endswith(
        "assumed: rows 4 m apart, 1 % of plants infested where nothing is known."
    )
    assert "rows 13.1234 ft apart" in apart(sentence([ROWS], UnitsInLanguage(length="ft")))
    assert sentence([], UnitsInLanguage()) == ""


def test_of_who_inspects_the_line_says_that_and_what_is_said_apart():
    units, assumed = UnitsInLanguage(), [KNOWN, Assumed("speed_m_s", 1.0), Assumed("stop_s", 2.0)]
    line, own = sentence(assumed, units), of_who_inspects(assumed, units)
    assert line.endswith(
        "where nothing is known, how fast and how thoroughly plants are inspected."
    )
    assert "km/h" not in line
    assert own == "Of who inspects: 3.6 km/h, a stop takes 2 s more, as in simulated drives."
    assert of_who_inspects([ROWS, KNOWN], units) == ""


def test_only_figures_that_rest_on_it_are_marked():
    assert mark("Plants", [ROWS], ("row_spacing_m",)) == "Plants *"
    assert mark("Plants", [KNOWN], ("row_spacing_m",)) == "Plants"
