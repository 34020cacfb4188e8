"""Records belong to a plot by where they are, or by the rows and plants that they name."""

import numpy as np
import pytest
import shapely

from fieldmon.errors import ChoiceNeeded, FileProblem, ObservationError, PlotError
from fieldmon.io.options import PlotOptions, RecordOptions
from fieldmon.io.plot_records import records_on
from fieldmon.io.plot_request import (
    PlotRequest,
    PlotSources,
    RecordSource,
)
from fieldmon.io.prepare import lay, prepare, prepare_estate
from fieldmon.plot.field import Field
from fieldmon.plot.grid import nearest_plants, plant_numbers
from fieldmon.plot.plot import Plot
from tests.io.three_parcels import (
    DAY,
    FRAME,
    MITES,
    PLOTS_AND_ROWS,
    ROWS,
    ZIP,
    area,
    csv,
    field_called,
    labelled_vines,
    one,
    place,
    said,
    same,
)
from tests.parcels import write_geojson


def test_records_that_name_rows_and_plants_lie_on_the_plants_of_those_numbers(parcels):
    made = prepare(one(parcels, "Plot 1", ROWS))
    np.testing.assert_allclose(made.records.lonlat, [place(made.plot, 3, 7)], atol=1e-12)
    assert made.records.count.tolist() == [4]
    assert "dropped: 1 record names 1 plant not known: 99/1." in said(made, "records")


def test_records_of_rows_on_another_plot_are_left_out_and_counted(parcels):
    made = prepare(one(parcels, "Plot 1", PLOTS_AND_ROWS))
    expected = [place(made.plot, 2, 3), place(made.plot, 4, 1)]
    np.testing.assert_allclose(made.records.lonlat, expected, atol=1e-12)
    sentences = said(made, "records")
    assert "dropped: 2 records are of 1 other plot: Plot 2." in sentences
    assert "dropped: 1 record names 1 plot not known: Moon." in sentences
    with pytest.raises(FileProblem, match="2 other plot"):
        prepare(one(parcels, "Plot 3", PLOTS_AND_ROWS))


def test_every_plot_of_an_estate_gets_its_own_rows_and_plants(parcels):
    estate = prepare_estate(one(parcels, records=PLOTS_AND_ROWS))
    first, second, third = estate.fields
    same(estate.records.on(first), prepare(one(parcels, "Plot 1", PLOTS_AND_ROWS)).records)
    expected = [place(lay(second).plot, 2, 3)]
    np.testing.assert_allclose(estate.records.on(second).lonlat, expected, atol=1e-12)
    assert len(estate.records.on(third)) == 0
    sentences = said(estate, "records")
    assert "dropped: Plot 2: 1 record names 1 plant not known: 99/1." in sentences
    assert sum("Moon" in sentence for sentence in sentences) == 1
    assert not any("other plot" in sentence for sentence in sentences)


def test_an_estate_is_asked_whose_rows_are_meant_where_the_file_does_not_say(parcels):
    with pytest.raises(ChoiceNeeded, match="does not say of which") as asked:
        prepare_estate(one(parcels, records=ROWS))
    question = asked.value
    assert (question.role, question.option) == ("records", "plot")
    assert question.choices == ("Plot 1", "Plot 2", "Plot 3")
    options = RecordOptions().choose(question.option, question.choices[1])
    estate = prepare_estate(one(parcels, records=ROWS, options=options))
    assert [len(estate.records.on(field)) for field in estate.fields] == [0, 1, 0]
    same(estate.records.on(estate.fields[1]), prepare(one(parcels, "Plot 2", ROWS)).records)


def test_an_answer_that_is_no_plot_is_asked_again(parcels):
    options = RecordOptions(plot="Sun")
    with pytest.raises(ChoiceNeeded, match="not 'Sun'"):
        prepare_estate(one(parcels, records=ROWS, options=options))
    with pytest.raises(FileProblem, match=r"1 plot not known: Sun"):
        prepare(one(parcels, "Plot 1", ROWS, options))


def test_an_estate_of_one_plot_is_not_asked(tmp_path):
    write_geojson(tmp_path / "one.geojson", [area(0, 0)])
    estate = prepare_estate(one(tmp_path / "one.geojson", records=ROWS))
    alone = prepare(one(tmp_path / "one.geojson", records=ROWS))
    same(estate.records.on(estate.fields[0]), alone.records)


def test_an_estate_of_which_one_plot_is_chosen_is_not_asked(parcels):
    estate = prepare_estate(one(parcels, "Plot 2", ROWS))
    assert [field.name for field in estate.fields] == ["Plot 2"]
    assert len(estate.records.on(estate.fields[0])) == 1


def test_a_plot_that_carries_no_plants_does_not_keep_the_others_from_their_records(tmp_path):
    tiny = FRAME.geometry_lonlat(shapely.box(500, 0, 502, 2))
    write_geojson(tmp_path / "two.geojson", [area(0, 0), tiny])
    estate = prepare_estate(one(tmp_path / "two.geojson", records=PLOTS_AND_ROWS))
    assert [len(estate.records.on(field)) for field in estate.fields] == [2, 0]
    assert any("2 records are of 1 other plot: Plot 2" in line for line in said(estate))
    only = csv(f"plot,row,plant,date,count\nPlot 2,1,1,{DAY},1\n")
    with pytest.raises(PlotError, match="room for one plant"):
        prepare_estate(one(tmp_path / "two.geojson", records=only))


def test_names_of_plots_are_compared_as_elsewhere(parcels):
    text = f"plot,row,plant,date,count\nPLOT-1,2,3,{DAY},4\nplot 2,1,1,{DAY},1\n"
    made = prepare(one(parcels, "Plot 1", csv(text)))
    assert len(made.records) == 1
    assert "guessed: Names were compared without capitals, spaces and marks." in said(made)


def test_a_file_that_names_parts_of_a_plot_asks_which_as_before(parcels):
    parts = csv(f"block,row,plant,date,count\nNorth,1,1,{DAY},4\nSouth,1,1,{DAY},0\n")
    with pytest.raises(ChoiceNeeded, match="must be of one plot") as asked:
        prepare(one(parcels, "Plot 1", parts))
    assert (asked.value.option, asked.value.role) == ("where", "records")
    options = RecordOptions().choose("where", asked.value.choices[1])
    assert prepare(one(parcels, "Plot 1", parts, options)).records.count.tolist() == [0]


def test_records_that_name_plots_lie_somewhere_on_them_alone_and_on_the_estate(parcels):
    named = csv(f"plot,date,count\nPlot 1,{DAY},4\nPlot 2,{DAY},2\nMoon,{DAY},2\n")
    estate = prepare_estate(one(parcels, records=named))
    for field in estate.fields[:2]:
        alone = prepare(one(parcels, field.name, named))
        same(estate.records.on(field), alone.records)
        (middle,) = alone.records.lonlat
        assert field.boundary.contains(shapely.Point(middle))
        area_m2 = field.frame().geometry_m(field.boundary).area
        assert alone.records.accuracy_m[0] == pytest.approx(np.sqrt(area_m2 / np.pi), rel=0.01)
    assert len(estate.records.on(estate.fields[2])) == 0


def test_positions_come_to_the_same_plots_alone_and_on_the_estate():
    estate = prepare_estate(one(ZIP, records=MITES))
    seen = 0
    for field in estate.fields[:3]:
        alone = prepare(one(ZIP, field.name, MITES)).records
        same(estate.records.on(field), alone)
        seen += len(alone)
    assert seen > 100


def test_records_that_all_lie_on_other_plots_of_the_file_are_told_which():
    wadi, pond = field_called("Wadi"), field_called("Pond")
    rows = [(wadi, 1), (pond, 2), (pond, 3)]
    table = "date,longitude,latitude,count\n" + "".join(
        f"{DAY},{at.x},{at.y},{count}\n"
        for field, count in rows
        for at in [field.boundary.representative_point()]
    )
    with pytest.raises(
        ObservationError,
        match=r"none of these 3 does. On other plots .* lie: Pond \(2\), Wadi \(1\). Choose",
    ):
        prepare(one(ZIP, "Gate", csv(table)))
    assert len(prepare(one(ZIP, "Pond", csv(table))).records) == 2
    far = csv(f"date,longitude,latitude,count\n{DAY},35.6,30.9,4\n")
    with pytest.raises(ObservationError, match="Check the choice of plot"):
        prepare(one(ZIP, "Gate", far))


def test_labels_of_measured_plants_can_be_named(parcels, tmp_path):
    plants = tmp_path / "vines.geojson"
    lonlat = labelled_vines(plants)
    named = RecordSource(csv(f"row,plant,date,count\nC,4,{DAY},4\n"))
    within = PlotSources(parcels, PlotOptions(feature="1"), plants)
    on_plot = prepare(PlotRequest(within, records=named))
    alone = prepare(PlotRequest(PlotSources(plants=plants, gate=(5.0, 45.0)), records=named))
    for made in (on_plot, alone):
        np.testing.assert_allclose(made.records.lonlat, lonlat[[23]], atol=1e-12)
        assert len(made.plot.grid) == 40
        assert made.assumed == ()
    assert (alone.plot.field.name, alone.plot.field.gate) == ("vines", (5.0, 45.0))
    assert on_plot.plot.field.name == "Plot 1"


def test_a_plot_whose_file_is_not_known_takes_records_of_its_rows():
    plot = Plot.of(Field("drawn", area(0, 0)))
    read = records_on(plot, RecordSource(ROWS))
    np.testing.assert_allclose(read.value.lonlat, [place(plot, 3, 7)], atol=1e-12)


def test_corners_of_plots_among_the_records_of_an_estate_are_left_out(parcels):
    fields = prepare_estate(one(parcels)).fields
    corners = shapely.get_coordinates(fields[1].boundary)[:-1]
    middle = fields[1].boundary.representative_point().coords[0]
    inside = np.add(middle, 1e-6 * np.arange(9)[:, None])
    rows = "".join(f"{float(x)},{float(y)},{DAY},1\n" for x, y in [*corners, *inside])
    estate = prepare_estate(one(parcels, records=csv(f"lon,lat,date,found\n{rows}")))
    assert len(estate.records.on(fields[1])) == len(inside)
    assert any("corners of plots" in line for line in said(estate, "records"))


def placed_twice(plot, column="", cell=""):
    """Return records at plants of a plot that name them, but for the sixth: it names another."""
    some = np.arange(40)
    numbered, lonlat = plant_numbers(plot.grid, some), plot.grid.lonlat(some)
    row = np.where(some == 5, plot.grid.line_number.max(), numbered.line)
    lines = [
        f"{DAY},{lon:.8f},{lat:.8f},{line},{number},1{cell}"
        for (lon, lat), line, number in zip(lonlat, row, numbered.number, strict=True)
    ]
    return csv(f"date,lon,lat,row,plant,count{column}\n" + "\n".join(lines))


@pytest.mark.parametrize("column", [("", ""), (",plot", ",Plot 1")])
def test_records_elsewhere_than_the_plants_they_name_are_doubted_and_the_answer_is_taken(
    parcels, column
):
    plot = prepare(one(parcels, "Plot 1")).plot
    records = placed_twice(plot, *column)
    doubt = "doubtful: {}1 of 40 records that give a position and name a plant lies elsewhere"
    made = prepare(one(parcels, "Plot 1", records))
    (told,) = [line for line in said(made, "records") if "elsewhere" in line]
    assert told.startswith(doubt.format(""))
    assert told.endswith("(Take the plants that they name: place=plant)")
    estate = prepare_estate(one(parcels, records=records))
    (told,) = [line for line in said(estate, "records") if "elsewhere" in line]
    assert told.startswith(doubt.format("" if column[0] else "Plot 1: "))
    for answer in ("plant", "position"):
        options = RecordOptions(place=answer)
        made = prepare(one(parcels, "Plot 1", records, options))
        assert not any("elsewhere" in line for line in said(made))
        plants = nearest_plants(plot.grid, made.records.lonlat, 1.0)[0]
        assert (plants[5] == 5) is np.bool_(answer == "position")
        assert np.delete(plants, 5).tolist() == [*range(5), *range(6, 40)]


def test_records_placed_twice_on_a_plot_without_room_are_taken_by_their_positions(tmp_path):
    tiny = FRAME.geometry_lonlat(shapely.box(500, 0, 502, 2))
    write_geojson(tmp_path / "two.geojson", [area(0, 0), tiny])
    lon, lat = FRAME.lonlat(np.array([[501.0, 1.0]]))[0]
    for column, cell in (("", ""), (",plot", ",Plot 2")):
        text = f"date,lon,lat,row,plant,count{column}\n{DAY},{lon:.8f},{lat:.8f},1,1,4{cell}\n"
        estate = prepare_estate(one(tmp_path / "two.geojson", records=csv(text)))
        assert [len(estate.records.on(field)) for field in estate.fields] == [0, 1]
        assert any("gives a position and names a plant, too" in line for line in said(estate))
