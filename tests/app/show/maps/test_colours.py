"""Plants are shaded by classes whose edges stand in the legend."""

import numpy as np
import pytest

from app.show.maps import colours

# of the page's style, light and dark
GROUND = {False: (233, 236, 228), True: (18, 24, 26)}


def shaded(shade):
    return [tuple(colour) for colour in shade.table[shade.rank].tolist()]


def test_chances_at_the_edge_of_a_class_are_in_the_upper_one():
    edges = np.array(colours.CHANCE_FROM)
    just_below = np.nextafter(edges[1:], 0)
    for dark in (False, True):
        classes = list(colours.of_chance(dark=dark))
        assert [c[:3] for c in shaded(colours.by_chance(edges, dark=dark))] == classes
        below = [c[:3] for c in shaded(colours.by_chance(just_below, dark=dark))]
        assert below == classes[:-1]
        assert shaded(colours.by_chance(np.array([1.0]), dark=dark))[0][:3] == classes[-1]


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


def lightness(classes):
    """Return CIE L* of colours: what is left of them in grey print."""
    linear = np.array(classes) / 255
    linear = np.where(linear <= 0.04045, linear / 12.92, ((linear + 0.055) / 1.055) ** 2.4)
    light = linear @ [0.2126, 0.7152, 0.0722]
    return np.where(light > 216 / 24389, 116 * np.cbrt(light) - 16, light * 24389 / 27)


def test_classes_are_told_apart_without_hue_and_the_highest_stands_out_most():
    light = lightness(colours.of_chance())
    assert (np.diff(light) < -6).all(), "each class is darker than the one below"
    dark = lightness(colours.of_chance(dark=True))
    assert (np.diff(dark) > 6).all(), "on dark ground each class is lighter"
    assert (np.diff(lightness(colours.AGE_COLOURS)) < -6).all()
    assert (np.diff(lightness(colours.AGE_IN_DARK)) > 6).all()


def test_the_lowest_class_is_seen_on_either_ground():
    for dark in (False, True):
        ground = GROUND[dark]
        contrast = np.abs(lightness(colours.of_chance(dark=dark)) - lightness([ground]))
        assert contrast.min() > 7
        assert contrast.argmax() == len(colours.CHANCE_FROM) - 1


def test_the_grounds_of_a_plan_are_told_apart_in_its_legend():
    for tone in (colours.PLAN, colours.PLAN_IN_DARK):
        headland, aisle = lightness([tone.headland]), lightness([tone.aisle])
        assert abs(headland - aisle) > 6


def test_a_dark_page_has_the_same_classes():
    for by, values in ((colours.by_chance, [0.0, 0.03, 0.9]), (colours.by_age, [0, 5, 40])):
        day, night = by(np.array(values)), by(np.array(values), dark=True)
        assert day.rank.tolist() == night.rank.tolist()
        assert shaded(day)[-1] != shaded(night)[-1]


def test_plain_plants_have_one_colour():
    assert len(set(shaded(colours.plain(5)))) == 1


def test_lines_of_rows_let_the_plants_under_them_be_seen_on_either_ground():
    for line in (colours.ROWS, colours.ROWS_IN_DARK):
        assert len(line) == 4
        assert line[3] < 128


# what one sees who lacks a kind of cones (Machado 2009), as shares of linear red, green and blue
_SEES = {
    "all": np.eye(3),
    "no red": [[0.152, 1.053, -0.205], [0.115, 0.786, 0.099], [-0.004, -0.048, 1.052]],
    "no green": [[0.367, 0.861, -0.228], [0.280, 0.673, 0.047], [-0.012, 0.043, 0.969]],
    "no blue": [[1.256, -0.077, -0.179], [-0.078, 0.931, 0.148], [0.005, 0.691, 0.304]],
}
_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])


def lab(colour, sees):
    """Return a colour as CIELAB."""
    light = np.clip(np.array(sees) @ (np.array(colour) / 255) ** 2.2, 0, 1)
    x, y, z = np.cbrt(np.maximum(_XYZ @ light / [0.9505, 1.0, 1.089], 1e-6))
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


@pytest.mark.parametrize("sees", _SEES)
@pytest.mark.parametrize("robots", [colours.ROBOTS, colours.ROBOTS_IN_DARK])
def test_robots_are_told_apart_whatever_colours_one_sees(robots, sees):
    seen = [lab(one, _SEES[sees]) for one in robots]
    apart = [np.linalg.norm(a - b) for k, a in enumerate(seen) for b in seen[:k]]
    assert min(apart) > 20  # 2 is just seen side by side
    assert colours.of_robot(len(robots)) == colours.of_robot(0)
