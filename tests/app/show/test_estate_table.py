"""The table of all plots: their order and state, and who works there when there is a plan."""

from datetime import datetime
from types import SimpleNamespace

import shapely

from app.show import estate_table
from app.state.estate import PlotState
from app.words import texts

OUTLINE = shapely.MultiPolygon([shapely.box(0, 0, 1, 1)])
PLOTS = [PlotState("b", "b", OUTLINE, days_since=4, expected=2.5), PlotState("a", "a", OUTLINE, 0)]


class Route(list):
    expected_found = 1.25

    def __len__(self):
        return 3


def turn(plot):
    plan = SimpleNamespace(route=Route())
    return SimpleNamespace(plot=plot, who="robot 1", begins=datetime(2026, 11, 16, 6),
                           ends=datetime(2026, 11, 16, 7, 30), plan=plan)  # fmt: skip


def test_plots_stand_in_their_order_with_their_state():
    table, _ = estate_table.of(PLOTS)
    names = texts.PLOTS_COLUMNS
    assert table[names["name"]].tolist() == ["b", "a"]
    assert table[names["expected"]].iloc[0] == 2.5
    assert list(estate_table.of(PLOTS[1:])[0]) == [names["name"]], "nothing is known of it"


def test_a_plan_says_who_works_where_and_leaves_the_others_empty():
    table, _ = estate_table.of(PLOTS, (turn(PLOTS[0]),))
    more = texts.PLAN_ALL_COLUMNS
    assert table[more["who"]].iloc[0] == "robot 1"
    assert table[list(more.values())].iloc[1].isna().all()
    assert table[[more["from"], more["to"]]].iloc[0].tolist() == ["06:00", "07:30"]
    assert table[more["plants"]].iloc[0] == 3
    assert table[more["finds"]].iloc[0] == 1.2
