"""The table of all plots: their order and state, and who works there when there is a plan."""

from datetime import datetime
from types import SimpleNamespace

import pytest
import shapely

from app.show import estate_table
from app.state.estate import PlotState
from app.words import texts
from fieldmon.compute.wording import LANGUAGES

OUTLINE = shapely.MultiPolygon([shapely.box(0, 0, 1, 1)])
PLOTS = [PlotState("b", "b", OUTLINE, days_since=4, expected=2.5), PlotState("a", "a", OUTLINE, 0)]


class Route(list):
    expected_finds = 1.25

    def __len__(self):
        return 3


def turn(plot):
    return SimpleNamespace(state=plot, who="robot 1", begins=datetime(2026, 11, 16, 6),
                           ends=datetime(2026, 11, 16, 7, 30), route=Route())  # fmt: skip


def test_plots_stand_in_their_order_with_their_area_and_state():
    table, _ = estate_table.of(PLOTS)
    names = texts.PLOTS_COLUMNS
    assert table[names["name"]].tolist() == ["b", "a"]
    # a degree square at the equator, on the ellipsoid: as `fieldmon plots` has it
    assert table["ha"].iloc[0] == pytest.approx(1.23e6)
    assert table[names["expected"]].iloc[0] == 2.5
    assert list(estate_table.of(PLOTS[1:])[0]) == [names["name"], "ha"], "no more is known of it"


@pytest.mark.parametrize("code", LANGUAGES)
def test_who_works_is_said_with_its_number_in_every_language(code, speaking):
    speaking(code)
    for name in (texts.ROBOT_NAMED, texts.SCOUT_NAMED):
        one = turn(PLOTS[0])
        one.who = str(name).format(n=10)
        table, how = estate_table.of(PLOTS, (one,))
        column = str(texts.PLAN_ALL_COLUMNS["who"])
        said = table[column].iloc[0]
        assert said.endswith(" 10")
        # letters of a table are some six pixels wide, and eight lie on each side
        assert 6.2 * len(said) + 16 <= how[column]["width"]


def test_a_plan_says_who_works_where_and_leaves_the_others_empty():
    table, _ = estate_table.of(PLOTS, (turn(PLOTS[0]),))
    more = texts.PLAN_ALL_COLUMNS
    assert table[more["who"]].iloc[0] == "robot 1"
    assert table[list(more.values())].iloc[1].isna().all()
    assert table[more["when"]].iloc[0] == "06:00-07:30"
    assert table[more["finds"]].iloc[0] == 1.2


@pytest.mark.parametrize("turns", [(), (turn(PLOTS[0]),)])
def test_every_column_has_room_beside_the_others_on_a_narrow_phone(turns):
    """A number whose end is out of sight is another number."""
    table, how = estate_table.of(PLOTS, turns)
    assert sum(how[name]["width"] for name in table) <= 300


def test_names_have_the_room_of_a_column_that_would_be_empty():
    new = PlotState("Schnorbach-Brückstück 2026", "a", OUTLINE, expected=2.5)
    name, days = texts.PLOTS_COLUMNS["name"], texts.PLOTS_COLUMNS["days_since"]
    table, _ = estate_table.of([new])
    assert days not in table
    assert table[name].iloc[0] == "Schnorbach-…kstück 2026"
    table, _ = estate_table.of([new, PLOTS[0]])
    assert table[days].iloc[1] == 4
    assert table[name].iloc[0] == "Schnorb…ck 2026"


def test_a_long_name_keeps_both_ends():
    names = [estate_table.shortened(f"lleida_apricot_orchards_epsg25831 ({k})") for k in range(96)]
    assert len(set(names)) == 96
    assert max(map(len, names)) <= 14
