"""Legends name every class and every sign with its colour, beside the layer it is of."""

import pytest

from app.show import map_layers
from app.show.maps import colours, legends
from tests.app.driving import apart


@pytest.mark.parametrize("dark", [False, True])
def test_every_class_of_chance_has_its_lower_end_and_its_colour(dark):
    part = legends.by_chance(dark=dark)
    kinds, shown, names = zip(*part["items"], strict=True)
    assert shown == colours.of_chance(dark=dark)
    assert tuple(map(apart, names)) == ("0 %", "1 %", "2 %", "5 %", "10 %", "25 %", "50 %+")
    assert set(kinds) == {"square"}
    assert part["scale"]
    assert part["of"] == "shade:chance"


def test_the_three_states_differ_by_shape_too():
    kinds, shown, names = zip(*legends.by_state()["items"], strict=True)
    assert names == ("found", "looked clean", "never inspected")
    assert shown == (colours.FOUND, colours.CLEAN, colours.NEVER)
    assert len(set(kinds)) == 3
    assert not legends.by_state()["title"], "it said the three signs' words once more"


def test_ages_are_whole_days_without_a_gap():
    kinds, shown, names = zip(*legends.by_age()["items"], strict=True)
    said = ["0 days ago", "1-2 days ago", "3-6 days ago", "7-13 days ago", "14+ days ago"]
    assert list(names) == [*said, "never inspected"]
    assert shown[:-1] == colours.AGE_COLOURS
    assert kinds[-1] == "ring"


@pytest.mark.parametrize("dark", [False, True])
def test_every_layer_that_can_be_switched_has_its_signs_in_its_own_colours(dark):
    parts = {part["of"]: part["items"] for part in legends.signs(dark=dark)}
    # words are no signs, a plan has its own in `legends.plan`, what was before only a switch
    without = {"numbers", "rows", "plan", "before"}
    assert set(parts) == set(map_layers.LAYERS_OF_SWITCH) - without, (
        "each of LAYERS_OF_SWITCH needs a part of its name in `legends.signs`, or one in `without`"
    )
    route, hot = (
        (colours.ROUTE_IN_DARK, colours.HOT_IN_DARK) if dark else (colours.ROUTE, colours.HOT)
    )
    assert [sign[:2] for sign in parts["route"]] == [("line", route)]
    assert [sign[:2] for sign in legends.gate()["items"]] == [("ring", colours.GATE)]
    assert parts["hot"][0][:2] == ("outline", hot)
    treated = colours.TREATED_IN_DARK if dark else colours.TREATED
    assert parts["treated"][0][:2] == ("outline", treated)
    seen, unseen = parts["records"]
    assert (seen[0], unseen[0]) == ("dot", "ring")
