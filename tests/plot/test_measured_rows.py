"""Which rows measured plants stand in: straight, bent, named; and what is doubtful about it."""

from contextlib import suppress
from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import example, given, settings
from hypothesis import strategies as st
from shapely import MultiPolygon

from fieldmon.errors import FieldmonError
from fieldmon.plot.block import Block
from fieldmon.plot.field import Field
from fieldmon.plot.grid import block_number
from fieldmon.plot.layout import grid_from_plants
from fieldmon.plot.measured_rows import SaidRows, name_numbers
from fieldmon.plot.plant_names import PlantNames
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot, plot_around
from fieldmon.plot.projection import Frame
from fieldmon.plot.row_detection import RowDirection, row_ends, rows_from_plants
from tests.bent import right_share

FRAME = Frame(8.0, 47.0)


def planted(n_rows=10, n_plants=40, radius_m=None, noise_m=0.03, seed=1):
    k, j = np.divmod(np.arange(n_rows * n_plants), n_plants)
    x, y = (j - n_plants / 2) * 1.4, k * 2.5
    xy_m = np.stack([x, y], axis=1)
    if radius_m is not None:
        at = radius_m + y
        xy_m = np.stack([at * np.sin(x / at), at * np.cos(x / at) - radius_m], axis=1)
    return xy_m + np.random.default_rng(seed).normal(0, noise_m, xy_m.shape), k


def rows_of(grid, xy_m):
    plant = grid.tree.query(grid.frame.xy_m(FRAME.lonlat(xy_m)))[1]
    return grid.row_line[grid.row[plant]]


def test_straight_rows_are_kept_as_they_were_before_rows_could_bend():
    xy_m, row = planted()
    grid = grid_from_plants(FRAME.lonlat(xy_m))
    assert grid.aisles_m is grid.block is grid.place_m is None
    assert right_share(rows_of(grid, xy_m), row) == 1.0
    assert grid.along_m.tolist() == grid.xy_m[:, 0].tolist()


@pytest.mark.parametrize("radius_m", [30.0, 60.0, 200.0])
def test_bent_rows_are_taken_as_they_bend(radius_m):
    xy_m, row = planted(radius_m=radius_m)
    plot = plot_around("bent", FRAME.lonlat(xy_m))
    assert plot.grid.aisles_m is not None
    assert right_share(rows_of(plot.grid, xy_m), row) == 1.0
    assert plot.rows.in_rows
    assert plot.rows.doubts == ()
    assert "in 10 rows, as they bend" in plot.rows.how


def test_a_bearing_that_is_said_keeps_rows_that_run_that_way():
    # as wide in the row as between rows, nearly: rows may be seen either way
    k, j = np.divmod(np.arange(400), 20)
    xy_m = np.stack([2.2 * j, 2.0 * k], axis=1)
    xy_m += np.random.default_rng(3).normal(0, 0.05, xy_m.shape)
    for bearing_deg in (90.0, 0.0):
        plot = plot_around("square", FRAME.lonlat(xy_m), Planting(row_bearing_deg=bearing_deg))
        off_deg = (plot.grid.frame.bearing_deg - bearing_deg + 90) % 180 - 90
        assert off_deg == pytest.approx(0.0, abs=1.0)
        assert plot.grid.n_rows == 20
        assert plot.rows.directions == ()


def test_names_of_rows_decide_where_they_tell_of_rows():
    xy_m, row = planted(radius_m=60.0)
    named = row.copy()
    far = xy_m[:, 0] > 10
    named[far & (row == 4)], named[far & (row == 5)] = 5, 4
    names = np.array([f"R{k}" for k in named])
    plot = plot_around("named", FRAME.lonlat(xy_m), names=PlantNames(names))
    assert right_share(rows_of(plot.grid, xy_m), named) == 1.0
    (doubt,) = [said for said in plot.rows.doubts if "seem to stand" in said]
    assert "in another row than the file names; the names decided" in doubt


def test_names_that_fit_are_checked_and_not_doubted():
    xy_m, row = planted(radius_m=60.0)
    plot = plot_around("named", FRAME.lonlat(xy_m), names=PlantNames(row.astype(np.str_)))
    assert plot.rows.misnamed_share == 0.0
    assert plot.rows.doubts == ()


def test_one_name_for_all_plants_is_no_name_of_a_row():
    xy_m, row = planted(radius_m=60.0)
    names = np.full(len(row), "Riesling")
    plot = plot_around("variety", FRAME.lonlat(xy_m), names=PlantNames(names))
    assert right_share(rows_of(plot.grid, xy_m), row) == 1.0
    assert "rows were found instead" in " ".join(plot.rows.doubts)


@pytest.mark.parametrize(("rows", "said"), [(["1", "2"], 1), (["1", "1"], 0), (["", ""], 0)])
def test_two_plants_stand_in_one_row_and_names_of_two_are_said_not_to_fit(rows, said):
    lonlat = FRAME.lonlat(np.array([[0.0, 0.0], [2.5, 0.0]]))
    plot = plot_around("two", lonlat, names=PlantNames(np.array(rows)))
    assert plot.grid.n_rows == 1
    doubt = "50 % of the plants seem to stand in another row than the file names; rows were found"
    assert sum(doubt in one for one in plot.rows.doubts) == said


def test_names_are_numbers_only_where_every_plant_has_one():
    assert name_numbers(None) is None
    assert name_numbers(np.array(["1", "", "2"])) is None
    assert name_numbers(np.array(["b", "a", "b"])).tolist() == [1, 0, 1]
    assert SaidRows(None, bearing=False).checked(np.empty((0, 2))).misnamed is None


def test_trees_that_stand_anyhow_are_in_no_rows():
    xy_m = np.random.default_rng(5).uniform(0, 120, (80, 2))
    plot = plot_around("park", FRAME.lonlat(xy_m))
    assert not plot.rows.in_rows
    assert plot.rows.doubts[0].startswith("No rows were found")
    assert len(plot.grid) == 80


def test_the_share_of_plants_off_their_row_is_said():
    xy_m, _ = planted(n_plants=60)
    stray = np.random.default_rng(2).random(len(xy_m)) < 0.06
    xy_m[stray] += np.where(xy_m[stray, :1] > 0, 0.7, -0.7) * np.array([1.0, 1.3])
    plot = plot_around("strays", FRAME.lonlat(xy_m))
    assert plot.rows.off_share == pytest.approx(stray.mean(), abs=0.02)
    said = f"{100 * plot.rows.off_share:.0f} % of the plants stand more"
    assert any(said in sentence for sentence in plot.rows.doubts)


def test_a_square_planting_has_rows_two_ways_and_takes_the_longer_ones():
    k, j = np.divmod(np.arange(12 * 30), 30)
    xy_m = 3.0 * np.stack([j, k], axis=1) + np.random.default_rng(1).normal(0, 0.05, (360, 2))
    rows = rows_from_plants(Frame(8.0, 47.0, 20.0).lonlat(xy_m))
    assert rows.bearing_deg == pytest.approx(20.0, abs=0.5)
    assert [(round(one.bearing_deg), one.n_rows) for one in rows.directions] == [
        (20, 12),
        (110, 30),
    ]
    assert [one.row_spacing_m for one in rows.directions] == pytest.approx([3.0, 3.0], abs=0.05)
    plot = plot_around("square", Frame(8.0, 47.0, 20.0).lonlat(xy_m))
    assert any("but also 30 rows along 110 degrees" in said for said in plot.rows.doubts)
    ends_m = Frame(8.0, 47.0, 20.0).xy_m(row_ends(plot.field.plants, 110.0, 3.0).reshape(-1, 2))
    assert np.ptp(ends_m.reshape(-1, 2, 2)[..., 1], axis=1) == pytest.approx(33.0, abs=0.4)


def test_a_triangular_planting_has_rows_three_ways():
    k, j = np.divmod(np.arange(20 * 20), 20)
    xy_m = 3.0 * np.stack([j + k / 2 - k // 2, k * np.sqrt(0.75)], axis=1)
    rows = rows_from_plants(Frame(8.0, 47.0, 10.0).lonlat(xy_m))
    ways = sorted(round(one.bearing_deg) for one in rows.directions)
    assert ways == [10, 70, 130]


@pytest.mark.parametrize(("n_rows", "way_deg"), [(3, 37.0), (2, 0.0), (4, 90.0)])
def test_a_few_rows_have_one_direction_only(n_rows, way_deg):
    k, j = np.divmod(np.arange(n_rows * 4), 4)
    xy_m = np.stack([3.0 * j, 4.0 * k], axis=1)
    plot = plot_around("small", Frame(8.0, 47.0, way_deg).lonlat(xy_m))
    assert not any("directions" in said for said in plot.rows.doubts)


def test_rows_to_the_north_run_along_0_degrees_and_not_along_180():
    assert str(RowDirection(179.7, 3, 4.0)) == "3 rows along 0 degrees"


@pytest.mark.parametrize("missing", [0.3, 0.4, 0.6, 0.7])
def test_plants_that_are_missing_make_no_pairs_of_those_left(missing):
    k, j = np.divmod(np.arange(20 * 60), 60)
    xy_m = np.stack([1.5 * j, 3.0 * k], axis=1)
    left = np.random.default_rng(3).random(len(xy_m)) > missing
    plot = plot_around("gaps", FRAME.lonlat(xy_m[left]))
    assert plot.rows.paired_share == 0.0


@pytest.mark.parametrize(("n", "left"), [(6, 7), (12, 14), (30, 30)])
def test_few_plants_left_of_three_rows_are_no_pairs_and_pairs_are(n, left):
    k, j = np.divmod(np.arange(3 * n), n)
    xy_m = np.stack([1.5 * j, 3.0 * k], axis=1)
    paired = 0
    for seed in range(10):
        kept = np.sort(np.random.default_rng(seed).permutation(len(xy_m))[:left])
        with suppress(FieldmonError):  # too few tell no rows
            paired += plot_around("gaps", FRAME.lonlat(xy_m[kept])).rows.paired_share >= 0.4
    assert paired <= 1
    two = np.stack([2.0 * (j // 2) + 0.4 * (j % 2), 3.0 * k], axis=1)
    report = plot_around("pairs", FRAME.lonlat(two)).rows
    assert report.paired_share == 1.0
    assert "stand in close pairs" in " ".join(report.doubts)


def in_blocks(spacings_m):
    """Return the plot of two straight blocks, each with its spacing, beside each other."""
    parts, of = [], []
    for number, spacing_m in enumerate(spacings_m):
        k, j = np.divmod(np.arange(8 * 30), 30)
        parts.append(np.stack([1.5 * j + 60.0 * number, spacing_m * k], axis=1))
        of += [f"B{number}"] * len(k)
    xy_m = np.concatenate(parts)
    lonlat = FRAME.lonlat(xy_m)
    blocks = np.array(of)
    return plot_around("blocks", lonlat, names=PlantNames(None, blocks)), blocks


def test_named_blocks_have_rows_and_spacings_of_their_own():
    plot, _ = in_blocks((2.5, 4.0))
    grid = plot.grid
    assert grid.n_blocks == 2
    assert grid.n_rows == 16
    block = block_number(grid)
    assert np.bincount(block)[1:].tolist() == [240, 240]
    n_across = np.diff(grid.across_start)
    for number in (1, 2):  # but for the outer rows each has a neighbour on both sides
        assert n_across[block == number].sum() == 2 * 7 * 30
    assert plot.rows.doubts == ()


def test_blocks_that_plants_name_within_rows_are_those_of_a_trial():
    xy_m, row = planted()
    names = np.where(xy_m[:, 0] > xy_m[:, 0].mean(), "I", "II")
    plot = plot_around("trial", FRAME.lonlat(xy_m), names=PlantNames(None, names))
    assert plot.grid.n_blocks == 1
    assert right_share(rows_of(plot.grid, xy_m), row) == 1.0
    assert "as those of a trial do; they were left aside" in " ".join(plot.rows.doubts)


def test_every_block_may_count_its_rows_from_one():
    plot, named = in_blocks((2.5, 2.5))
    lonlat = plot.field.plants
    rows = np.array([str(k // 30 % 8) for k in range(480)])
    again = plot_around("both", lonlat, names=PlantNames(rows, named))
    assert again.grid.n_rows == 16
    assert again.rows.misnamed_share == 0.0


def test_measured_plants_are_in_the_blocks_that_were_drawn():
    xy_m = np.stack([*np.meshgrid(1.5 * np.arange(40), 2.5 * np.arange(16))], axis=-1)
    xy_m = xy_m.reshape(-1, 2)
    field = Field("drawn", FRAME.geometry_lonlat(MultiPolygon([shapely.box(-9, -9, 68, 47)])))
    halves = [shapely.box(-9, -9, 68, 18.7), shapely.box(-9, 18.7, 68, 47)]
    blocks = tuple(
        Block(str(k), FRAME.geometry_lonlat(MultiPolygon([half]))) for k, half in enumerate(halves)
    )
    plot = Plot.of(replace(field, blocks=blocks, plants=FRAME.lonlat(xy_m)))
    assert plot.grid.n_blocks == 2
    assert np.bincount(block_number(plot.grid))[1:].tolist() == [320, 320]


def test_a_block_of_a_plant_or_two_is_a_row():
    xy_m = np.concatenate([planted()[0], [[200.0, 0.0]], [[300.0, 0.0], [302.0, 0.0]]])
    n = len(xy_m)
    names = np.array(["home"] * (n - 3) + ["one"] + ["two"] * 2)
    plot = plot_around("few", FRAME.lonlat(xy_m), names=PlantNames(None, names))
    assert plot.grid.n_blocks == 3
    assert len(plot.grid) == n


def doubled(half_m, apart_m, stagger, radius_m=None, noise_m=0.02):
    """Return twelve double rows 3 m apart, a twentieth missing; the double row and line of each."""
    rng = np.random.default_rng(0)
    k, j = np.divmod(np.arange(12 * 40), 40)
    x = np.concatenate([j - 20, j - 20 + stagger]) * apart_m
    y = np.concatenate([3.0 * k - half_m, 3.0 * k + half_m])
    xy_m = np.stack([x, y], axis=1)
    if radius_m is not None:
        at = radius_m + y
        xy_m = np.stack([at * np.sin(x / at), at * np.cos(x / at) - radius_m], axis=1)
    xy_m += rng.normal(0, noise_m, xy_m.shape)
    kept = rng.random(len(xy_m)) > 0.05
    return xy_m[kept], np.tile(k, 2)[kept], np.concatenate([2 * k, 2 * k + 1])[kept]


# every two of the values meet: in nine of the 36 plots
@pytest.mark.parametrize(
    ("radius_m", "half_m", "stagger", "apart_m"),
    [
        *((None, 0.15, 0.0, 0.4), (80.0, 0.15, 0.5, 1.0), (None, 0.15, 0.5, 1.4)),
        *((80.0, 0.25, 0.5, 0.4), (None, 0.25, 0.0, 1.0), (80.0, 0.25, 0.0, 1.4)),
        *((None, 0.4, 0.5, 0.4), (None, 0.4, 0.5, 1.0), (80.0, 0.4, 0.0, 1.4)),
    ],
)
def test_double_rows_are_told_of_abreast_or_staggered(radius_m, half_m, stagger, apart_m):
    xy_m, _, _ = doubled(half_m, apart_m, stagger, radius_m)
    assert plot_around("double", FRAME.lonlat(xy_m)).rows.doubts != ()


@pytest.mark.parametrize("radius_m", [None, 80.0])
@pytest.mark.parametrize("noise_m", [0.02, 0.08])
def test_a_staggered_double_row_is_one_row_and_said_to_be(radius_m, noise_m):
    xy_m, pair, _ = doubled(0.15, 1.0, 0.5, radius_m, noise_m)
    plot = plot_around("double", FRAME.lonlat(xy_m))
    assert right_share(rows_of(plot.grid, xy_m), pair) >= 0.99
    assert plot.rows.zigzag_m == pytest.approx(0.15, abs=0.02)
    assert any("0.15 m to its left and right by turns" in said for said in plot.rows.doubts)


def test_double_rows_taken_as_two_are_said_with_both_distances():
    xy_m, _, line = doubled(0.25, 0.5, 0.5)
    plot = plot_around("double", FRAME.lonlat(xy_m))
    assert right_share(rows_of(plot.grid, xy_m), line) >= 0.99
    assert plot.rows.gaps_m == pytest.approx((0.5, 2.5), abs=0.05)
    assert any("0.50 and 2.50 m apart by turns" in said for said in plot.rows.doubts)


@settings(max_examples=10)
@given(
    size=st.tuples(st.integers(5, 12), st.integers(15, 30)),
    closer=st.floats(0.6, 1.1),
    bend=st.floats(0.1, 0.9),
    seed=st.integers(0, 2**32),
)
@example(size=(5, 15), closer=0.8125, bend=0.875, seed=0)
def test_rows_that_bend_and_are_nearly_square_are_right_or_doubted(size, closer, bend, seed):
    k, j = np.divmod(np.arange(size[0] * size[1]), size[1])
    at = max(size[1] * 3.0 * closer / bend, 45.0) + 3.0 * k
    turn = (j - size[1] / 2) * 3.0 * closer / at
    xy_m = np.stack([at * np.sin(turn), at * np.cos(turn) - at[0]], axis=1)
    rng = np.random.default_rng(seed)
    kept = rng.permutation(np.flatnonzero(rng.random(len(k)) > 0.1))
    xy_m = xy_m[kept] + rng.normal(0.0, 0.1, (len(kept), 2))
    plot = plot_around("square", FRAME.lonlat(xy_m))
    assert right_share(rows_of(plot.grid, xy_m), k[kept]) >= 0.99 or plot.rows.doubts


def test_straight_rows_that_have_nothing_to_do_with_each_other_are_no_square():
    xy_m, row = planted()
    xy_m[:, 0] *= 1.5
    xy_m[:, 0] += np.random.default_rng(8).uniform(0, 2.1, 10)[row]
    plot = plot_around("orchard", FRAME.lonlat(xy_m))
    assert plot.grid.plant_spacing_m / plot.grid.row_spacing_m == pytest.approx(0.84, abs=0.03)
    assert plot.rows.nearly_square_m is None


@pytest.mark.parametrize("radius_m", [None, 80.0])
@pytest.mark.parametrize("noise_m", [0.0, 0.05, 0.2])
def test_single_rows_are_no_double_rows(radius_m, noise_m):
    plot = plot_around("single", FRAME.lonlat(planted(radius_m=radius_m, noise_m=noise_m)[0]))
    assert (plot.rows.zigzag_m, plot.rows.gaps_m) == (0.0, None)


def test_two_plants_close_in_a_row_are_in_that_row():
    xy_m, row = planted(noise_m=0.02)
    both = np.concatenate([xy_m, xy_m[::3] + np.array([0.3, 0.0])])
    plot = plot_around("close", FRAME.lonlat(both))
    found = rows_of(plot.grid, both)
    assert right_share(found, np.concatenate([row, row[::3]])) == 1.0
