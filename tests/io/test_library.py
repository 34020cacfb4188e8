"""Reading in one call: what the doors of the app read, with doubts as warnings."""

import json
import warnings

import numpy as np
import pytest

from fieldmon.errors import ChoiceNeeded, ImportDoubt, SettingError
from fieldmon.infestation.prior.raster_risk import RiskSettings
from fieldmon.io import library, read
from fieldmon.io.options import PlotOptions, ReadOptions, Upload
from fieldmon.io.plot_request import PlantingChoices, PlotRequest, PlotSources, RiskSource
from fieldmon.io.prepare import prepare, risk_on
from fieldmon.plot.plot import Plot
from tests.io.rasters import raster_files
from tests.paths import SAMPLE_DATA

ESTATE = SAMPLE_DATA / "paran_estate.zip"
ROWS = PlantingChoices(row_bearing_deg=20.0, row_spacing_m=4.0, plant_spacing_m=3.0)


@pytest.fixture(scope="module")
def gate():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return library.read_plot(ESTATE, feature="Gate")


def heard(call, *arguments, **options):
    """Return what a call gives, and the sentences of the doubts that it warns of."""
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        given = call(*arguments, **options)
    assert {warning.category for warning in said} <= {ImportDoubt}
    assert {warning.filename for warning in said} <= {__file__}, "not where it was asked"
    return given, [str(warning.message) for warning in said]


def test_a_plot_is_the_one_that_the_doors_of_the_app_read(gate):
    (wanted,) = read.read_plots(ESTATE, PlotOptions(feature="Gate")).value
    assert gate.field.boundary.equals(wanted.boundary)
    assert library.read_plot(ESTATE, feature=1, planting=ROWS).field.name == "Gate"


PLANTS = "Ost,Nord,row,plant\n" + "".join(
    f"{5 + 3e-5 * row},{45 + 2e-5 * k},{row},{k}\n" for row in (7, 8, 9) for k in range(11, 19)
)
LINES = [[[5 + 3e-5 * k, 45], [5 + 3e-5 * k, 45.0004]] for k in range(4)]


def test_a_plot_is_read_from_its_plants_alone_or_its_rows_alone_as_commands_do():
    file = Upload("vines.csv", PLANTS.encode())
    columns = {"lon": "Ost", "lat": "Nord"}
    plot, _ = heard(library.read_plot, plants=file, columns=columns)
    assert (plot.field.name, plot.n_plants) == ("vines", 24)
    options = ReadOptions().naming(**columns)
    by_command = prepare(PlotRequest(PlotSources(plants=file, plants_options=options))).plot
    assert {*plot.grid.row_line_number.tolist()} == {7, 8, 9}
    assert plot.to_geopandas().equals(by_command.to_geopandas())
    line = json.dumps({"type": "MultiLineString", "coordinates": LINES})
    drawn, said = heard(library.read_plot, rows=Upload("rows.geojson", line.encode()))
    assert drawn.grid.n_rows == 4
    assert any("No boundary was given" in one for one in said)


def test_without_any_file_or_with_a_plot_chosen_in_none_it_is_said_what_to_give():
    with pytest.raises(SettingError, match="Give a file of plots, or the positions"):
        library.read_plot()
    with pytest.raises(SettingError, match="Only a file of plots has one that is chosen"):
        library.read_plot(plants=Upload("vines.csv", PLANTS.encode()), feature="Gate")


def test_what_is_assumed_of_the_rows_is_a_warning_and_what_is_said_is_none():
    square = "5,45 5.002,45 5.002,45.001 5,45.001"
    rows = "\n".join(square.split())
    file = Upload("square.csv", f"lon,lat\n{rows}\n".encode())
    _, assumed = heard(library.read_plot, file)
    assert any("planting=" in sentence for sentence in assumed)
    _, quiet = heard(library.read_plot, file, planting=ROWS)
    assert len(quiet) < len(assumed)
    assert not [sentence for sentence in quiet if "planting=" in sentence]


def test_options_are_told_as_python_has_them(gate):
    lon, lat = gate.grid.frame.lonlat(gate.grid.xy_m[:1])[0]
    file = Upload("r.csv", f"Ost,Nord,Tag,Milben\n{lon},{lat},2026-11-01,3\n".encode())
    as_dict = {"lon": "Ost", "lat": "Nord", "date": "Tag", "count": "Milben"}
    for columns in (as_dict, [f"{role}={name}" for role, name in as_dict.items()]):
        assert heard(library.read_records, file, gate, columns=columns)[0].count.tolist() == [3]
    _, doubts = heard(library.read_plots, ESTATE, near=(35.0, 29.0))
    assert [one for one in doubts if "from the plot or place nearby" in one]


def asked_by(read, *given, **options):
    with pytest.raises(ChoiceNeeded) as question:
        read(*given, **options)
    return str(question.value)


def test_a_question_says_which_option_answers_it_as_python_has_it(gate):
    assert asked_by(library.read_plot, ESTATE).endswith("Answer with feature='Gate', for instance.")
    odd = Upload("odd.csv", b"a,b\n5,45\n5.1,45\n5,45.1\n")
    for given in ({"source": odd}, {"plants": odd}):
        assert "Answer with columns={'lon': 'a'}, for" in asked_by(library.read_plot, **given)
    lon, lat = gate.grid.frame.lonlat(gate.grid.xy_m[:1])[0]
    bare = Upload("r.csv", f"lon,lat,date\n{lon},{lat},2026-11-01\n".encode())
    assert "Answer with columns={'present': ''}" in asked_by(library.read_records, bare, gate)
    assert len(heard(library.read_records, bare, gate, columns={"present": ""})[0]) == 1
    lines = Upload("l.geojson", b'{"type": "LineString", "coordinates": [[5, 45], [5.1, 45]]}')
    assert "as rows=FILE or paths=FILE" in asked_by(library.read_plot, lines)
    # how a second file is read cannot be said here
    second = asked_by(library.read_plot, ESTATE, "Gate", odd)
    assert "Name them." in second
    assert "Answer with" not in second


def test_a_plot_may_have_paths_and_be_parted_into_blocks():
    arms = "7,49 7.004,49 7.004,49.0005 7.0008,49.0005 7.0008,49.003 7,49.003"
    file = Upload("L.csv", "\n".join(["lon,lat", *arms.split()]).encode())
    parted, _ = heard(library.read_plot, file, guess_blocks=True)
    assert parted.grid.n_blocks > 1
    assert heard(library.read_plot, file, guess_blocks="Off")[0].grid.n_blocks == 1
    with pytest.raises(SettingError, match="guess_blocks must be yes or no, but it is 'ja'"):
        library.read_plot(file, guess_blocks="ja")
    tracks = SAMPLE_DATA / "tracks.geojson"
    assert heard(library.read_plot, ESTATE, "Gate", paths=tracks)[0].field.paths


def test_several_plots_are_asked_apart_and_the_answer_is_an_argument():
    with pytest.raises(ChoiceNeeded) as asked:
        library.read_plot(ESTATE)
    assert asked.value.option == "feature"
    for choice in asked.value.choices[:2]:
        assert library.read_plot(ESTATE, feature=choice, planting=ROWS).field.name == choice


def test_a_gate_of_ones_own_is_where_the_day_begins(gate):
    there = tuple(gate.grid.lonlat(np.array([40]))[0] + [0.0, -0.0001])
    plot = library.read_plot(ESTATE, feature="Gate", planting=ROWS, gate=there)
    assert plot.field.gate == there


def test_outlines_of_all_plots_come_without_plants():
    fields = library.read_plots(ESTATE)
    assert len(fields) > 3
    assert [field.plants for field in fields] == [None] * len(fields)


def test_records_are_those_near_the_plot_and_options_are_taken_as_text(gate):
    table = "lon,lat,date,count\n{0},{1},03/04/2026,2\n{2},{3},05/06/2026,1\n"
    (lon, lat), far = gate.grid.lonlat(np.array([7]))[0], 0.3
    file = Upload("r.csv", table.format(lon, lat, lon + far, lat).encode())
    records, doubts = heard(library.read_records, file, gate)
    assert records.day.astype(str).tolist() == ["2026-04-03"]
    assert any("day first" in sentence for sentence in doubts)
    told, doubts = heard(library.read_records, file, gate, date_order="mdy")
    assert told.day.astype(str).tolist() == ["2026-03-04"]
    assert not [sentence for sentence in doubts if "day first" in sentence]


def test_inspections_take_their_day_and_who_from_arguments(gate):
    file = Upload("d.csv", b"plant,found\n17,yes\n18,no\n19,\n")
    done, _ = heard(library.read_inspections, file, gate, day="2026-11-18", who="Ann")
    assert done.plant.tolist() == [17, 18]
    assert done.date.astype(str).tolist() == ["2026-11-18"] * 2
    assert set(done.who.tolist()) == {"Ann"}


def test_inspections_that_name_another_plot_are_left_out(gate):
    file = Upload("d.csv", b"plot,plant,found\nGate,17,yes\nPond,18,no\n")
    done, doubts = heard(library.read_inspections, file, gate)
    assert done.plant.tolist() == [17]
    assert any("1 record is of 1 other plot: Pond." in sentence for sentence in doubts)
    told, _ = heard(library.read_inspections, file, gate, columns={"plot": ""})
    assert told.plant.tolist() == [17, 18]


@pytest.mark.parametrize(("name", "told"), [("paths", 3), ("rows", True), ("contours", 3)])
def test_what_is_no_file_is_refused_by_its_name(name, told):
    with pytest.raises(SettingError, match=f"A file of {name} must be given by its path"):
        library.read_plot(ESTATE, feature="Gate", **{name: told})


@pytest.mark.parametrize(
    ("call", "more"),
    [
        (library.read_plots, ()),
        (library.read_records, ("gate",)),
        (library.read_inspections, ("gate",)),
    ],
)
def test_an_option_that_there_is_none_of_is_refused(call, more, gate):
    with pytest.raises(SettingError, match="no option 'colour'"):
        call(ESTATE, *(gate for _ in more), colour="red")


def test_the_risk_of_a_raster_is_that_of_commands_and_what_it_means_is_asked(tmp_path):
    plot = Plot.of(raster_files.PLOT)
    values = raster_files.ramp()
    path = raster_files.write(tmp_path / "ndvi.tif", values)
    said = {"mean_share": 0.04, "low_is_risky": True}
    risk, doubts = heard(library.read_risk, path, plot, "rank", **said)
    assert doubts == []
    settings = RiskSettings("rank", **said)
    assert np.array_equal(risk, risk_on(plot, RiskSource(path, settings)).value)
    with pytest.raises(ChoiceNeeded, match=r"Answer with meaning='rank', for instance\.$"):
        library.read_risk(path, plot)
    with pytest.raises(SettingError, match=r"must be one of chance, .*, but it is None"):
        library.read_risk(path, plot, **said)
    alike = raster_files.write(tmp_path / "alike.tif", np.full_like(values, 0.3))
    assert heard(library.read_risk, alike, plot, "chance")[1]
    with pytest.raises(SettingError, match="'low_is_risky' of read_risk must be True or False"):
        library.read_risk(path, plot, "rank", mean_share=0.04, low_is_risky=1)
