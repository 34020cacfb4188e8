"""All plots on one map: each where it is, in the colour of its state, found again by a tap."""

import numpy as np
import pytest
import shapely

from app.show import estate_map
from app.state.estate import PlotState
from app.words import texts


def a_plot(name, west, parts=1, **state):
    boxes = [shapely.box(west + k, 30.0, west + k + 0.5, 30.5) for k in range(parts)]
    return PlotState(name, name, shapely.MultiPolygon(boxes), **state)


PLOTS = [
    a_plot("new", 35.0),
    a_plot("never", 40.0, parts=2, expected=3.0),
    a_plot("today", 45.0, expected=2.0, days_since=0),
    a_plot("late", 50.0, expected=1.0, days_since=7),
]


@pytest.mark.parametrize(
    ("days", "expected", "state"),
    [(None, None, "new"), (None, 1.0, "late"), (0, 1.0, "fresh"), (2, 1.0, "fresh"),
     (3, 1.0, "due"), (6, 1.0, "due"), (7, 1.0, "late"), (99, 1.0, "late")],
)  # fmt: skip
def test_a_plot_is_late_a_week_after_it_was_seen(days, expected, state):
    assert estate_map.state_of(a_plot("x", 35.0, days_since=days, expected=expected)) == state


def test_a_pond_stays_a_hole():
    pond = shapely.box(35.1, 30.1, 35.2, 30.2)
    outline = shapely.MultiPolygon([shapely.box(35.0, 30.0, 35.5, 30.5).difference(pond)])
    content = estate_map.content([PlotState("home", "home", outline)])
    (layer,) = (one for one in content.layers if one.id == estate_map.PLOTS)
    ((_, hole),) = (row["p"] for row in layer.data)
    assert shapely.Polygon(hole).equals(pond)


def test_every_part_of_a_plot_is_drawn_where_it_is_and_leads_to_it():
    (layer,) = (one for one in estate_map.content(PLOTS).layers if one.id == estate_map.PLOTS)
    assert len(layer.data) == 5
    for index, row in enumerate(layer.data):
        tapped = estate_map.plot_tapped(PLOTS, index)
        middle = shapely.Point(np.mean(row["p"][0][:-1], axis=0))
        assert tapped.outline.contains(middle)
    assert estate_map.plot_tapped(PLOTS, 5) is None
    assert estate_map.plot_tapped(PLOTS, -1) is None


def test_every_plot_has_a_dot_that_leads_to_it_also_where_others_lie_on_it():
    same = PlotState("again", "again", PLOTS[0].outline, expected=1.0)
    plots = [*PLOTS, same]
    content = estate_map.content(plots)
    (areas,) = (one for one in content.layers if one.id == estate_map.PLOTS)
    dots = content.layers[-1]
    assert dots.id == estate_map.MARKS
    for number, (plot, row) in enumerate(zip(plots, dots.data, strict=True)):
        assert plot.outline.contains(shapely.Point(row["p"]))
        assert row["around"] == list(plot.outline.bounds)
        assert estate_map.plot_tapped(plots, number, estate_map.MARKS) is plot
        own = next(one for one in areas.data if one["n"] == number)
        assert row["c"][:3] == own["c"][:3], "as its area"
    assert estate_map.plot_tapped(plots, 0, "route") is None
    assert [label["plot"] for label in content.labels] == [0, 1, 2, 3, 4]


def test_the_dot_of_several_plots_is_of_the_one_that_waits_most():
    ((new, never, today, late),) = (
        [row["urgent"] for row in one.data]
        for one in estate_map.content(PLOTS).layers
        if one.id == estate_map.MARKS
    )
    assert never == late < today < new


def test_all_plots_are_in_view_with_their_names():
    content = estate_map.content(PLOTS)
    assert content.bounds == [35.0, 30.0, 50.5, 30.5]
    assert [one["t"] for one in content.labels] == [plot.name for plot in PLOTS]
    assert all(plot.name in content.alt for plot in PLOTS)


def test_the_legend_says_the_states_that_there_are_in_the_colours_of_the_plots():
    content = estate_map.content(PLOTS)
    said = {words: colour for part in content.legend for _, colour, words in part["items"]}
    assert set(said) == {texts.PLOTS_STATES[name] for name in ("new", "late", "fresh")}
    states = ("new", "late", "late", "fresh", "late")
    for row, state in zip(content.layers[0].data, states, strict=True):
        assert tuple(row["c"][:3]) == said[texts.PLOTS_STATES[state]]
    assert len(set(said.values())) == len(said)


def test_a_plot_says_what_is_expected_and_when_it_was_seen_unless_nobody_asked():
    new, never, today, late = map(estate_map.said, PLOTS)
    assert not any(letter.isdigit() for letter in new)
    assert texts.PLOTS_SEEN[None] in never
    assert texts.PLOTS_SEEN[0] in today
    assert "7" in late


def test_a_plot_whose_plan_was_hardly_begun_is_late_but_not_never_seen():
    begun = a_plot("begun", 35.0, expected=1.0, is_begun=True)
    assert texts.PLOTS_SEEN["begun"] in estate_map.said(begun)
    assert estate_map.state_of(begun) == "late"
