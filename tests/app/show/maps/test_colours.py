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


def light(classes):
    """Return the relative luminance of colours."""
    return (np.array(classes) / 255) ** 2.2 @ np.array([0.2126, 0.7152, 0.0722])


@pytest.mark.parametrize(
    ("page", "classes"),
    [
        ((255, 255, 255), colours.CHANCE_COLOURS),
        ((255, 255, 255), colours.AGE_COLOURS),
        ((18, 24, 26), colours.CHANCE_IN_DARK),
        ((18, 24, 26), colours.AGE_IN_DARK),
    ],
)
def test_classes_stand_out_from_the_page_more_and_more_and_without_hue(page, classes):
    high = np.maximum(light(classes), light([page])) + 0.05
    contrast = high / (np.minimum(light(classes), light([page])) + 0.05)
    assert (np.diff(contrast) > 0).all()
    assert contrast[-1] > 10, "the most likely are the most visible"
    assert contrast[0] > 1.04


def test_a_dark_page_has_the_same_classes():
    for by, values in ((colours.by_chance, [0.0, 0.03, 0.9]), (colours.by_age, [0, 5, 40])):
        day, night = by(np.array(values)), by(np.array(values), dark=True)
        assert day.rank.tolist() == night.rank.tolist()
        assert shaded(day)[-1] != shaded(night)[-1]


def test_plain_plants_have_one_colour():
    assert len(set(shaded(colours.plain(5)))) == 1
