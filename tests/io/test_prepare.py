"""From files to a prepared plot."""

from dataclasses import replace

import geopandas
import numpy as np
import pytest
import rasterio
import shapely
from rasterio.transform import from_bounds

from fieldmon.errors import ChoiceNeeded, FileProblem, SettingError
from fieldmon.infestation.prior.raster_risk import RiskSettings
from fieldmon.io.options import PlotOptions, ReadOptions
from fieldmon.io.plot_records import records_on
from fieldmon.io.plot_request import (
    CanopySource,
    PlantingChoices,
    PlotRequest,
    PlotSources,
    RecordSource,
    RiskSource,
)
from fieldmon.io.prepare import lay, one_of, prepare, prepare_estate
from fieldmon.io.prepared_plots import Laid
from fieldmon.io.read import read_plots
from tests.io.three_parcels import (
    DAY,
    FRAME,
    PLOTS_AND_ROWS,
    ROWS,
    TRACKS,
    ZIP,
    area,
    csv,
    one,
    place,
    said,
    same,
)
from tests.parcels import write_geojson


def test_what_nobody_said_is_assumed_and_said(parcels):
    made = prepare(one(parcels, "Plot 1"))
    assert {a.setting: round(a.value, 3) for a in made.assumed} == {
        "row_spacing_m": 4.0,
        "plant_spacing_m": 3.0,
        "row_bearing_deg": 90.0,
    }
    assert [str(a) for a in made.assumed] == [
        "guessed: row spacing 4 m",
        "guessed: plant spacing 3 m",
        "guessed: row bearing 90.0 degrees, along the longest side",
    ]
    told = prepare(one(parcels, "Plot 1", planting=PlantingChoices(row_spacing_m=5.0)))
    assert [a.setting for a in told.assumed] == ["plant_spacing_m", "row_bearing_deg"]
    assert told.plot.grid.row_spacing_m == pytest.approx(5.0)
    assert prepare(one(ZIP, "Nursery")).assumed == ()


def test_one_row_of_measured_plants_tells_of_no_row_spacing(tmp_path):
    lines = [f"5.0,{45 + 1.8e-5 * k:.7f}" for k in range(12)]
    (tmp_path / "vines.csv").write_text("\n".join(["lon,lat", *lines]))
    sources = PlotSources(plants=tmp_path / "vines.csv")
    made = prepare(PlotRequest(sources))
    assert [str(a) for a in made.assumed] == ["guessed: row spacing 4 m"]
    told = prepare(PlotRequest(sources, PlantingChoices(row_spacing_m=2.5)))
    assert (told.assumed, told.plot.grid.row_spacing_m) == ((), 2.5)


def test_what_is_said_by_hand_goes_before_what_the_file_states():
    choices = PlantingChoices(row_spacing_m=6.0, faces=2)
    stated = prepare(one(ZIP, "Nursery")).plot.grid
    told = prepare(one(ZIP, "Nursery", planting=choices)).plot.grid
    assert stated.row_spacing_m != pytest.approx(6.0)
    assert told.row_spacing_m == pytest.approx(6.0)
    assert (told.twin >= 0).any()
    assert choices.given() == {"row_spacing_m": 6.0, "faces": 2}


def test_a_spacing_that_no_rows_have_is_refused_with_file_column_and_value(tmp_path):
    file = tmp_path / "wrong.gpkg"
    areas = [shapely.box(x, 30.36, x + 1e-3, 30.361) for x in (35.15, 35.16)]
    columns = {"name": ["wide", "usual"], "row_dist": [5000, 4]}
    geopandas.GeoDataFrame(columns, geometry=areas, crs=4326).to_file(file)
    said = "wrong.gpkg: of plot 'wide', column 'row_dist' must be 0.05 to 1000 metres, but it is"
    with pytest.raises(FileProblem, match=f"^{said} 5000[.] Correct it, or say it by hand[.]$"):
        prepare(one(file, "wide"))
    assert prepare(one(file, "usual")).plot.grid.row_spacing_m == 4.0
    by_hand = PlantingChoices(row_spacing_m=5.0)
    assert prepare(one(file, "wide", planting=by_hand)).plot.grid.row_spacing_m == 5.0


def test_all_spacings_that_no_rows_have_are_named_at_once(tmp_path):
    file = tmp_path / "wrong.gpkg"
    areas = [shapely.box(35.15, 30.36, 35.151, 30.361)]
    columns = {"name": ["wide"], "row_dist": [5000], "plant_dist": [0.001], "headland": [4]}
    geopandas.GeoDataFrame(columns, geometry=areas, crs=4326).to_file(file)
    with pytest.raises(FileProblem) as problem:
        prepare(one(file, "wide"))
    said = str(problem.value)
    assert "column 'row_dist' must be 0.05 to 1000 metres, but it is 5000; column " in said
    assert "'plant_dist' must be 0.05 to 1000 metres, but it is 0.001." in said
    assert said.endswith("Correct it, or say it by hand.")


@pytest.mark.parametrize(("gate", "away"), [((35.0, 30.0), "4"), ((30.349, 35.141), "69")])
def test_a_gate_from_which_nobody_drives_in_a_day_is_refused_with_its_distance(gate, away):
    sources = PlotSources(ZIP, PlotOptions(feature="Nursery"), gate=gate)
    with pytest.raises(SettingError, match=f"The gate at .* lies {away}[.0-9]* km from Nursery"):
        prepare(PlotRequest(sources))


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
    bare = CanopySource(low, 0.5, how="nearest")
    risky = RiskSource(low, RiskSettings("chance"), how="nearest")
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


def test_plants_of_the_neighbouring_plot_are_left_out_and_those_just_outside_are_said(tmp_path):
    spots = FRAME.lonlat(np.array([(3.0 * k, y) for y in (3.0, -2.0, -60.0) for k in range(15)]))
    lines = [f"{lon:.8f},{lat:.8f},{k}" for k, (lon, lat) in enumerate(spots.tolist())]
    vines = csv("\n".join(["lon,lat,plant", *lines]), "vines.csv")
    write_geojson(tmp_path / "home.geojson", [area(-2.0, 0.0)])
    request = one(tmp_path / "home.geojson", records=csv(f"plant,date,count\n3,{DAY},4\n"))

    def with_far(far):
        sources = replace(request.sources, plants=vines, plants_options=ReadOptions(far=far))
        return prepare(replace(request, sources=sources))

    made = with_far(None)
    assert len(made.plot.grid) == 30
    np.testing.assert_allclose(made.records.lonlat, [spots[3]], atol=1e-8)
    heard = said(made, "plants")
    assert (
        "dropped: 15 of 45 plants stand outside Plot 1 and were left out: 60 m away. "
        "(Keep them: far=keep)"
    ) in heard
    assert (
        "doubtful: 15 plants stand outside Plot 1, up to 2 m away, and are taken to be of it: a "
        "boundary may be drawn tight. (Leave them out: far=drop)"
    ) in heard
    assert len(with_far("keep").plot.grid) == 45
    assert len(with_far("drop").plot.grid) == 15
