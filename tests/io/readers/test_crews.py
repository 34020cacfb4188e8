"""Who works on a plot, as the columns of its file say."""

import pytest

from fieldmon.io.readers.crews import Crew, crews_of
from tests.io.tables_of_cells import table

B_ASIDE = {"hours": "", "speed_m_s": "Column 'speed_km_h' was left aside: it says 'x'."}


def test_each_plot_has_its_own_crew_and_what_is_not_said_is_none():
    layer = table(name=["a", "b"], crew=["Ann", ""], hours=["3,5", None], speed_km_h=[2.5, "x"])
    read = crews_of(layer, ["a", "b"])
    assert read.value == {"a": Crew("Ann", 3.5, 2.5), "b": Crew(left_aside=B_ASIDE)}
    (doubt,) = read.messages
    assert "'speed_km_h' says" in doubt.sentence
    assert "1 plot: b ('x')" in doubt.sentence


@pytest.mark.parametrize(
    ("column", "field"),
    [("robot", "who"), ("Worker", "who"), ("INSPECTOR", "who"), ("Hours per day", "hours"),
     ("work hours", "hours"), ("Speed (km/h)", "speed_km_h"), ("speed", "speed_km_h"),
     ("look_s", "look_s"), ("Seconds per plant", "look_s")],
)  # fmt: skip
def test_columns_are_known_by_what_people_call_them(column, field):
    (crew,) = crews_of(table(**{column: ["7"]}), ["a"]).value.values()
    assert getattr(crew, field) == ("7" if field == "who" else 7.0)
    assert sum(value is not None for value in crew) == 1


def test_what_no_robot_can_be_set_to_is_told_with_its_column_and_unit():
    crews = crews_of(table(speed=[0, 4, 200], hours=[4, -1, 4]), ["a", "b", "c"]).value
    assert crews["a"].wrong == {"speed_m_s": "Column 'speed' must be above 0 km/h, but it is 0."}
    assert crews["b"].wrong == {"hours": "Column 'hours' must be above 0 h, but it is -1."}
    assert "108 km/h at most, but it is 200." in crews["c"].wrong["speed_m_s"]


def test_of_two_columns_that_could_be_it_the_plainer_name_is_taken():
    (crew,) = crews_of(table(working_hours=[9], hours=[4]), ["a"]).value.values()
    assert crew.hours == 4.0


def test_a_file_that_says_nothing_leaves_everything_open():
    assert crews_of(table(crop=["vine", "vine"]), ["a", "b"]).value == {"a": Crew(), "b": Crew()}
    assert crews_of(table(crop=[]), []).value == {}
