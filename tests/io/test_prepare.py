"""From files to a prepared plot."""

import json

import numpy as np
import pytest
import rasterio
import shapely
from rasterio.transform import from_bounds
from shapely import MultiPolygon

from fieldmon.errors import ChoiceNeeded, FileProblem, ObservationError, PlotError, SettingError
from fieldmon.io.options import PlotOptions, RecordOptions, Upload
from fieldmon.io.prepare import Laid, lay, one_of, prepare, prepare_estate, records_on
from fieldmon.io.read import read_plots
from fieldmon.io.sources import (
    CanopySource,
    PlantingChoices,
    PlotRequest,
    PlotSources,
    RecordSource,
    RiskSource,
)
from fieldmon.plot.field import Field
from fieldmon.plot.grid import plant_at
from fieldmon.plot.plot import Plot
from fieldmon.plot.projection import Frame
from tests.parcels import write_geojson
from tests.paths import SAMPLE_DATA

ZIP, MITES = SAMPLE_DATA / "paran_estate.zip", SAMPLE_DATA / "mite_records.csv"
TRACKS = SAMPLE_DATA / "tracks.geojson"
FRAME = Frame(5.0, 45.0)
DAY = "2026-03-01"


def area(x, y, high=30.0):
    return FRAME.geometry_lonlat(MultiPolygon([shapely.box(x, y, x + 60.0, y + high)]))


@pytest.fixture
def parcels(tmp_path):
    """Return a file of three plots, half a kilometre apart, that states nothing about rows."""
    write_geojson(tmp_path / "parcels.geojson", [area(0, 0), area(500, 0, 40), area(0, 500, 50)])
    return tmp_path / "parcels.geojson"


def csv(text, name="records.csv"):
    return Upload(name, text.encode())


ROWS = csv(f"row,plant,date,count\n3,7,{DAY},4\n99,1,{DAY},2\n")
PLOTS_AND_ROWS = csv(
    f"plot,row,plant,date,count\nPlot 1,2,3,{DAY},4\nPlot 2,2,3,{DAY},0\nPlot 2,99,1,{DAY},2\n"
    f"Moon,1,1,{DAY},1\nPlot 1,4,1,{DAY},1\n"
)


def one(file, feature=None, records=None, options=None, **more):
    """Return what to prepare of one plot."""
    source = None if records is None else RecordSource(records, options or RecordOptions())
    return PlotRequest(PlotSources(file, PlotOptions(feature=feature)), records=source, **more)


def said(prepared, role=None):
    return [m.message.line() for m in prepared.messages if role in {None, m.role}]


def place(plot, row, plant):
    return plot.grid.lonlat(np.array([plant_at(plot.grid, row, plant)]))[0]


def same(observations, other):
    for name, values in vars(observations).items():
        np.testing.assert_array_equal(values, getattr(other, name))


def test_records_that_name_rows_and_plants_lie_on_the_plants_of_those_numbers(parcels):
    made = prepare(one(parcels, "Plot 1", ROWS))
    np.testing.assert_allclose(made.records.lonlat, [place(made.plot, 3, 7)], atol=1e-12)
    assert made.records.count.tolist() == [4]
    assert "dropped: 1 record(s) name 1 plant(s) that are not known: 99/1." in said(made, "records")


def test_records_of_rows_on_another_plot_are_left_out_and_counted(parcels):
    made = prepare(one(parcels, "Plot 1", PLOTS_AND_ROWS))
    expected = [place(made.plot, 2, 3), place(made.plot, 4, 1)]
    np.testing.assert_allclose(made.records.lonlat, expected, atol=1e-12)
    sentences = said(made, "records")
    assert "dropped: 2 record(s) are of 1 other plot(s): Plot 2." in sentences
    assert "dropped: 1 record(s) name 1 plot(s) that are not known: Moon." in sentences
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
    assert "dropped: Plot 2: 1 record(s) name 1 plant(s) that are not known: 99/1." in sentences
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
    with pytest.raises(FileProblem, match=r"1 plot\(s\) that are not known: Sun"):
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
    assert any("2 record(s) are of 1 other plot(s): Plot 2" in line for line in said(estate))
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


def field_called(name):
    return read_plots(ZIP, PlotOptions(feature=name)).value[0]


def labelled_vines(path):
    """Write forty vines on the first plot, rows called A to D; return their positions."""
    lonlat = FRAME.lonlat(
        np.array([(6.0 + 3 * i, 5.0 + 4 * j) for j in range(4) for i in range(10)])
    )
    features = [
        {
            "type": "Feature",
            "geometry": {"type": "Point", "coordinates": spot.tolist()},
            "properties": {"row": "ABCD"[k // 10], "plant": str(k % 10 + 1)},
        }
        for k, spot in enumerate(lonlat)
    ]
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    return lonlat


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


def test_what_nobody_said_is_assumed_and_said(parcels):
    made = prepare(one(parcels, "Plot 1"))
    assert {a.setting: a.value for a in made.assumed} == {
        "row_spacing_m": 4.0,
        "plant_spacing_m": 3.0,
    }
    assert [str(a) for a in made.assumed] == [
        "guessed: row spacing 4 m",
        "guessed: plant spacing 3 m",
    ]
    told = prepare(one(parcels, "Plot 1", planting=PlantingChoices(row_spacing_m=5.0)))
    assert [a.setting for a in told.assumed] == ["plant_spacing_m"]
    assert told.plot.grid.row_spacing_m == pytest.approx(5.0)
    assert prepare(one(ZIP, "Nursery")).assumed == ()


def test_what_is_said_by_hand_goes_before_what_the_file_states():
    choices = PlantingChoices(row_spacing_m=6.0, faces=2)
    stated = prepare(one(ZIP, "Nursery")).plot.grid
    told = prepare(one(ZIP, "Nursery", planting=choices)).plot.grid
    assert stated.row_spacing_m != pytest.approx(6.0)
    assert told.row_spacing_m == pytest.approx(6.0)
    assert (told.twin >= 0).any()
    assert choices.given() == {"row_spacing_m": 6.0, "faces": 2}


def test_paths_and_gate_belong_to_the_plot():
    sources = PlotSources(ZIP, PlotOptions(feature="Nursery"), paths=TRACKS, gate=(35.141, 30.349))
    made = prepare(PlotRequest(sources))
    assert not made.plot.field.paths.is_empty
    assert made.plot.field.gate == (35.141, 30.349)
    estate = prepare_estate(PlotRequest(PlotSources(ZIP, paths=TRACKS)))
    assert all(shapely.equals(f.paths, made.plot.field.paths) for f in estate.fields)


def test_one_plot_of_several_is_asked_for_by_no_file(parcels):
    with pytest.raises(ChoiceNeeded, match="the file holds 3: Plot 1, Plot 2, Plot 3") as asked:
        prepare(one(parcels))
    assert (asked.value.option, asked.value.role) == ("feature", "")
    fields = read_plots(parcels).value
    assert one_of(fields[1:2]) is fields[1]


def test_without_any_plot_there_is_nothing_to_prepare():
    with pytest.raises(SettingError, match="Give a file of plots"):
        prepare(PlotRequest(PlotSources()))
    with pytest.raises(SettingError, match="Give a file of plots"):
        prepare_estate(PlotRequest(PlotSources()))


class Ear:
    """Notes what it hears."""

    def __init__(self):
        self.heard = []

    def message(self, said):
        self.heard.append((said.role, said.source))

    def laid(self, laid):
        assert isinstance(laid, Laid)
        self.heard.append(("laid", laid.plot.field.name))


def test_a_listener_hears_at_once_also_where_a_later_file_is_of_no_use(parcels):
    ear = Ear()
    with pytest.raises(FileProblem):
        prepare(one(parcels, "Plot 1", csv("", "empty.csv")), ear)
    assert ear.heard[-1] == ("laid", "Plot 1")
    assert ("plot", "parcels.geojson") in ear.heard
    ear = Ear()
    made = prepare(one(parcels, "Plot 1", ROWS), ear)
    messages = [each for each in ear.heard if each[0] != "laid"]
    assert messages == [(m.role, m.source) for m in made.messages]
    assert {m.source for m in made.messages if m.role == "records"} == {"records.csv"}


def canopy(path, plot):
    """Write a raster of a plot: low in its west half, high in its east half."""
    bounds = plot.field.boundary.buffer(1e-4).bounds
    values = np.ones((200, 200), "float32")
    values[:, :100] = 0.1
    with rasterio.open(
        path, "w", driver="GTiff", count=1, height=200, width=200, dtype="float32",
        crs="EPSG:4326", transform=from_bounds(*bounds, 200, 200),
    ) as tif:  # fmt: skip
        tif.write(values, 1)
    return path


def test_records_name_plants_as_they_were_planted_and_missing_ones_go_afterwards(parcels, tmp_path):
    whole = prepare(one(parcels, "Plot 1")).plot
    low = canopy(tmp_path / "canopy.tif", whole)
    bare, risky = CanopySource(low, 0.5, how="nearest"), RiskSource(low, how="nearest")
    made = prepare(one(parcels, "Plot 1", ROWS, canopy=bare, risk=risky))
    np.testing.assert_allclose(made.records.lonlat, [place(whole, 3, 7)], atol=1e-12)
    assert 0.3 < len(made.plot.grid) / len(whole.grid) < 0.7
    assert made.plot.grid.lonlat()[:, 0].min() > whole.grid.lonlat()[:, 0].min() + 2e-4
    assert made.risk.shape == (len(made.plot.grid),)
    np.testing.assert_allclose(made.risk, 1.0)
    roles = [m.role for m in made.messages]
    assert roles == sorted(roles, key=["plot", "records", "canopy", "risk"].index)


def test_step_by_step_is_all_at_once(parcels):
    fields, choices = read_plots(parcels).value, PlantingChoices(headland_m=6.0)
    plot = lay(fields[0], choices).plot
    read = records_on(plot, RecordSource(PLOTS_AND_ROWS), lambda: fields)
    at_once = prepare(one(parcels, "Plot 1", PLOTS_AND_ROWS, planting=choices))
    same(read.value, at_once.records)
    np.testing.assert_array_equal(plot.grid.xy_m, at_once.plot.grid.xy_m)
    assert [m.line() for m in read.messages] == said(at_once, "records")


def test_a_plot_whose_file_is_not_known_takes_records_of_its_rows():
    plot = Plot.of(Field("drawn", area(0, 0)))
    read = records_on(plot, RecordSource(ROWS))
    np.testing.assert_allclose(read.value.lonlat, [place(plot, 3, 7)], atol=1e-12)


def test_crews_are_those_of_the_file(tmp_path):
    shapes = [area(0, 0), area(500, 0)]
    write_geojson(tmp_path / "p.geojson", shapes, robot=["scout", None], hours=[3.0, None])
    estate = prepare_estate(one(tmp_path / "p.geojson"))
    said = [(estate.crew(field).who, estate.crew(field).hours) for field in estate.fields]
    assert said == [("scout", 3.0), (None, None)]
