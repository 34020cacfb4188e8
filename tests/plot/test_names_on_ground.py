"""Names of rows and plants that do not fit the ground are doubted, where others are in order."""

import numpy as np
import pytest
import shapely
from shapely import MultiPolygon

from fieldmon.errors import PlotError
from fieldmon.plot.field import Field
from fieldmon.plot.names_on_ground import out_of_order
from fieldmon.plot.plant_names import PlantNames
from fieldmon.plot.plot import Plot, plot_around
from fieldmon.plot.projection import Frame

FRAME = Frame(34.9, 31.5, 90.0)
# sixteen rows of twelve, 3 m and 2 m apart: the first is the southernmost
ROW, PLANT = np.divmod(np.arange(16 * 12), 12)
XY_M = np.stack([2.0 * PLANT, 3.0 * ROW], axis=1)


def named(rows, plants=None, blocks=None):
    """Return the plot of the plants with names."""
    names = (None if one is None else np.array(one, np.str_) for one in (rows, blocks, plants))
    return plot_around("own", FRAME.lonlat(XY_M), names=PlantNames(*names))


def doubts(rows, plants=None, blocks=None):
    """Return what is doubted of names, but for what other modules say."""
    said = named(rows, plants, blocks).doubts
    return [one for one in said if "amid another row" in one or "order of" in one]


def changed(values, **at):
    """Return values with others at some places, by ``k7=115``."""
    values = values.copy()
    for place, other in at.items():
        values[int(place[1:])] = other
    return values


@pytest.mark.parametrize("noise_m", [0.0, 0.2])
@pytest.mark.parametrize(("rows", "plants"), [
    (ROW + 101, PLANT + 1), (16 - ROW, 12 - PLANT), (2 * ROW + 1, np.arange(192)),
    (np.where(ROW < 8, 2 * ROW + 1, 2 * (16 - ROW)), np.where(ROW % 2, PLANT, 12 - PLANT) + 1),
    (np.random.default_rng(2).permutation(16)[ROW], np.random.default_rng(2).permutation(192)),
    (np.array(list("ABCDEFGHIJKLMNOP"))[ROW], None),
    (np.array(list("DAMCPENBGJFHOKIL"))[ROW], None),
])  # fmt: skip
def test_names_in_order_or_in_none_raise_no_doubt(rows, plants, noise_m, monkeypatch):
    moved = XY_M + np.random.default_rng(5).normal(0, noise_m, XY_M.shape)
    monkeypatch.setitem(globals(), "XY_M", moved)
    assert doubts(rows, plants) == []


@pytest.mark.parametrize(("place", "row", "said"), [
    (5, 115, "plant 6 of row 115 stands in row 101, 42 m from the rest of its row"),
    (0, 115, "plant 1 of row 115 stands in row 101, 42 m from the rest of its row"),
    (17, 103, "plant 6 of row 103 stands in row 102, 3 m from the rest of its row"),
    (29, 777, "plant 6 of row 777 stands in row 103, and no other plant is of its row"),
])  # fmt: skip
def test_a_plant_amid_another_row_than_it_names_is_named(place, row, said):
    (doubt,) = doubts(changed(ROW + 101, **{f"k{place}": row}), PLANT + 1)
    assert doubt == (
        f"1 plant stands amid another row than the file names: {said}. Rows are drawn as the file "
        "names them: correct its row there."
    )


def test_a_plant_without_a_name_is_named_by_its_place():
    (doubt,) = doubts(changed(ROW + 101, k5=115))
    lon, lat = FRAME.lonlat(XY_M[5:6])[0]
    assert f"plant {lon:.6f} / {lat:.6f} of row 115 stands in row 101" in doubt


def test_of_many_plants_that_stray_the_first_few_are_named():
    (doubt,) = doubts(changed(ROW + 101, **{f"k{12 * k + 5}": 116 for k in range(7)}), PLANT + 1)
    assert doubt.startswith("7 plants stand amid another row than the file names: plant 6 of")
    assert doubt.count(" stands in row ") == 5
    assert "; .... Rows are drawn as the file names them: correct their rows there." in doubt


def test_a_refusal_of_rows_out_of_reach_names_the_plant_that_strays():
    moat = shapely.box(-60, 16, 60, 90).difference(shapely.box(-30, 17, 52, 60))
    around, walled = (
        FRAME.geometry_lonlat(MultiPolygon([one])) for one in (shapely.box(-6, -6, 28, 51), moat)
    )
    rows = changed(ROW + 101, k5=115)
    names = PlantNames(rows.astype(np.str_), None, (PLANT + 1).astype(np.str_))
    with pytest.raises(PlotError, match=r"rows are not: 106–116\. Move .* plant 6 of row 115 st"):
        Plot.of(names.on(Field("own", around, no_go=walled, plants=FRAME.lonlat(XY_M))))


@pytest.mark.parametrize(("rows", "said"), [
    ({2: 107, 6: 103}, "but for 2: row 107 stands between 102 and 104, row 103 stands between 106"),
    ({0: 116, 15: 101}, "but for 2: row 116 stands beside 102, row 101 stands beside 115"),
    ({4: 130}, "but for 1: row 130 stands between 104 and 106. Look whether names are exchanged"),
])  # fmt: skip
def test_rows_out_of_the_order_of_the_others_are_named(rows, said):
    called = np.array([rows.get(k, k + 101) for k in range(16)])
    (doubt,) = doubts(called[ROW], PLANT + 1)
    assert said in doubt


def test_letters_have_an_order_too():
    (doubt,) = doubts(np.array(list("ABGDEFCHIJKLMNOP"))[ROW])
    assert "row 3 · G stands between 2 · B and 4 · D" in doubt


def test_rows_are_in_order_block_by_block(monkeypatch):
    west = PLANT < 6
    monkeypatch.setitem(globals(), "XY_M", XY_M + np.where(west, 0.0, 20.0)[:, None] * [1, 0])
    blocks = np.where(west, "west", "east")
    assert doubts(np.where(west, ROW, 15 - ROW) + 1, None, blocks) == []
    rows = np.where(west & (ROW == 2), 7, np.where(west & (ROW == 6), 3, ROW + 1))
    (doubt,) = doubts(rows, None, blocks)
    assert "but for 2: row" in doubt


@pytest.mark.parametrize("keys", [[], [3, 1, 2], [1, 2, 3, 3, 5, 4, 7, 8], list("bdacfehg")])
def test_few_or_mixed_keys_have_no_order(keys):
    assert out_of_order(keys) == []


@pytest.mark.parametrize("backwards", [False, True])
def test_plants_out_of_the_order_of_the_others_are_named(backwards):
    plants = PLANT + 1
    plants[40], plants[44] = plants[44], plants[40]
    if backwards:
        plants = 13 - plants
    (doubt,) = doubts(ROW + 101, plants)
    some = "(9, 4, 7, 6)" if backwards else "(4, 9, 6, 7)"
    assert f"but for those of 1 row: row 104 {some}. Look whether their numbers" in doubt
    assert doubts(None, plants) == [doubt.replace("row 104", "row 4")]


def test_plants_whose_numbers_tell_none_apart_are_in_no_order():
    plants = np.where(ROW == 3, 1, PLANT + 1)
    assert doubts(ROW + 101, plants) == []
    assert doubts(ROW + 101, np.char.add("v", plants.astype(np.str_))) == []


@pytest.mark.parametrize(("place", "row", "said"), [
    (24, 104, "plant 1 of row 104 stands in row 103, "),
    (35, 102, "plant 12 of row 102 stands in row 103, "),
    (0, 102, "plant 1 of row 102 stands in row 101, "),
])  # fmt: skip
@pytest.mark.parametrize("noise_m", [0.0, 0.2])
def test_the_first_or_the_last_plant_that_names_the_next_row_is_named(
    place, row, said, noise_m, monkeypatch
):
    moved = XY_M + np.random.default_rng(5).normal(0, noise_m, XY_M.shape)
    monkeypatch.setitem(globals(), "XY_M", moved)
    (doubt,) = doubts(changed(ROW + 101, **{f"k{place}": row}), PLANT + 1)
    assert said in doubt


@pytest.mark.parametrize("by_turns", [False, True])
def test_a_row_that_is_numbered_from_the_other_end_is_named(by_turns):
    backwards = ROW % 2 == 1 if by_turns else np.zeros(len(ROW), bool)
    plants = np.where(backwards, 12 - PLANT, PLANT + 1)
    turned = np.where(ROW == 6, 13 - plants, plants)
    said = [one for one in named(ROW + 101, turned).doubts if "other end" in one]
    (doubt,) = said
    assert doubt == (
        "Plants of 1 row are numbered from the other end than those of all others: 107. Look "
        "whether it was counted so; if not, turn its numbers in the file."
    )
    mixed = np.where(np.isin(ROW, [2, 3, 7, 8, 12]), 12 - PLANT, PLANT + 1)
    for others in (plants, mixed):
        assert not [one for one in named(ROW + 101, others).doubts if "other end" in one]
