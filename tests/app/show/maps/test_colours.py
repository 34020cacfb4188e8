"""Plants are shaded by classes whose edges stand in the legend."""

import numpy as np
import pytest

from app.show.maps import colours


def shaded(shade):
    return [tuple(colour) for colour in shade.table[shade.rank].tolist()]


def test_chances_at_the_edge_of_a_class_are_in_the_upper_one():
    edges = np.array(colours.CHANCE_FROM)
    just_below = np.nextafter(edges[1:], 0)
    assert [c[:3] for c in shaded(colours.by_chance(edges))] == list(colours.CHANCE_COLOURS)
    below = [c[:3] for c in shaded(colours.by_chance(just_below))]
    assert below == list(colours.CHANCE_COLOURS[:-1])
    assert shaded(colours.by_chance(np.array([1.0])))[0][:3] == colours.CHANCE_COLOURS[-1]


def test_found_plants_win_a_pixel_from_clean_ones_and_these_from_unseen_ones():
    shade = colours.by_state(np.array([-1, 0, 1], np.int8))
    assert shade.rank.tolist() == [0, 1, 2]
    never, clean, found = shaded(shade)
    assert never[:3] == colours.NEVER
    assert never[3] < 60
    assert (clean, found) == ((*colours.CLEAN, 255), (*colours.FOUND, 255))


@pytest.mark.parametrize(
    ("days", "age"), [(0, 0), (2, 1), (3, 2), (6, 2), (7, 3), (14, 4), (99, 4)]
)
def test_days_since_an_inspection_are_in_the_class_that_holds_them(days, age):
    assert shaded(colours.by_age(np.array([days])))[0][:3] == colours.AGE_COLOURS[age]


def test_a_plant_never_inspected_is_an_empty_ring_by_age_too():
    assert shaded(colours.by_age(np.array([-1]))) == shaded(
        colours.by_state(np.array([-1], np.int8))
    )


def test_classes_grow_darker_so_that_they_are_told_apart_without_hue():
    weights = np.array([0.2126, 0.7152, 0.0722])
    for classes in (colours.CHANCE_COLOURS, colours.AGE_COLOURS):
        light = (np.array(classes) / 255) ** 2.2 @ weights
        assert (np.diff(light) < 0).all()


def test_plain_plants_have_one_colour():
    assert len(set(shaded(colours.plain(5)))) == 1
