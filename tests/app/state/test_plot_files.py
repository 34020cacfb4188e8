"""From a session's files to a plot."""

from datetime import date
from pathlib import Path

import numpy as np
import pytest
from shapely import LineString, MultiLineString

from app.show.maps import colours
from app.state import plot_files
from app.state.brought_files import File
from fieldmon.infestation.prior.prior import prior_chance
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.io.options import Upload
from fieldmon.io.plot_request import PlotRequest, PlotSources, RecordSource
from fieldmon.io.prepare import prepare
from fieldmon.plot.grid import plant_at, plant_numbers
from fieldmon.plot.plot import Plot
from tests.app.driving import (
    geotiff,
    go,
    layer,
    plants,
    plot_name,
    square,
    texts_of,
    upload,
    zipped,
)


def test_an_uploaded_plot_and_records_are_planned(app, tmp_path):
    mites = b"date,lon,lat,count\n2026-11-10,35.1505,30.3605,9\n"
    plot = zipped(tmp_path, square(name="שדה"))
    upload(app, plot=("plot.zip", plot), record=("mites.csv", mites))
    assert not app.exception
    assert plot_name(app) == "שדה"
    go(app, "today")
    shown = plants(app)
    worst = shown.lonlat[np.argmax(shown.chance)]
    assert worst == pytest.approx([35.1505, 30.3605], abs=4e-5)


PLANTS = b"row,plant,date,count\n2,3,2026-11-10,9\n2,4,2026-11-12,0\n5,1,2026-11-14,2\n"


def test_records_by_row_and_plant_are_planned_as_the_commands_plan_them(app, tmp_path):
    data = zipped(tmp_path, square(0.0008))
    upload(app, plot=("plot.zip", data), record=("mites.csv", PLANTS))
    assert not app.exception
    assert not [*app.error, *app.warning]
    assert "3 of 3 records shown (2 with pests, 1 without)" in texts_of(app)
    app.date_input[0].set_value(date(2026, 11, 16)).run()
    go(app, "today")
    shown = plants(app)
    request = PlotRequest(
        PlotSources(Upload("plot.zip", data)), records=RecordSource(Upload("mites.csv", PLANTS))
    )
    made = prepare(request)
    chance = prior_chance(
        made.plot.grid, made.plot.field, made.records, np.datetime64("2026-11-16"), PriorSettings()
    )
    numbered = plant_numbers(made.plot.grid)
    shade = colours.by_chance(chance)
    assert shown.row.tolist() == numbered.line.tolist()
    assert shown.number.tolist() == numbered.number.tolist()
    assert shown.colour.tolist() == shade.table[shade.rank].tolist()
    assert shown.chance == pytest.approx(chance, abs=1e-7)
    two_three, two_four, five_one = (
        chance[plant_at(made.plot.grid, *place)] for place in ((2, 3), (2, 4), (5, 1))
    )
    assert chance.max() == five_one > two_three > two_four


def test_records_that_name_plants_which_are_missing_stay_at_theirs(app, tmp_path):
    """The numbers that records give count every plant laid, also those a raster takes away."""
    upload(app, plot=("plot.zip", zipped(tmp_path, square(0.0008))),
           record=("mites.csv", PLANTS))  # fmt: skip
    records = layer(app, "records")["data"]
    before = len(plants(app, "plants"))
    low = geotiff(np.full((40, 40), 0.2, np.float32), (35.15, 30.36, 35.1504, 30.3608))
    app.file_uploader(key="missing_plants_file").upload("canopy.tif", low).run()
    assert len(plants(app, "plants")) < before
    assert layer(app, "records")["data"] == records


def test_records_by_row_and_plant_name_the_labels_of_measured_plants(app):
    measured = "\n".join(
        f"{35 + x / 4e4:.6f},{30 + y / 4e4:.6f},R{y},{x + 100}" for x in range(6) for y in range(9)
    )
    upload(app, plant=("plants.csv", f"lon,lat,row,plant\n{measured}\n".encode()),
           record=("mites.csv", b"row,plant,date,count\nR3,102,2026-11-10,9\n"))  # fmt: skip
    assert not [*app.error, *app.warning]
    (record,) = layer(app, "records")["data"]
    assert record["p"] == pytest.approx([35 + 2 / 4e4, 30 + 3 / 4e4], abs=1e-6)


def test_plants_of_the_neighbouring_plot_are_left_out_until_a_button_keeps_them(app, tmp_path):
    measured = "\n".join(
        f"{lon + x / 4e4:.6f},{30.3602 + y / 4e4:.6f}"
        for lon in (35.1502, 35.1522) for x in range(6) for y in range(9)
    )  # fmt: skip
    upload(app, plot=("plot.zip", zipped(tmp_path, square(0.0008))),
           plant=("plants.csv", f"lon,lat\n{measured}\n".encode()))  # fmt: skip
    assert "54 of 108 plants stand outside" in texts_of(app)
    assert len(plants(app, "plants")) == 54
    next(one for one in app.button if one.label == "Keep them").click().run()
    assert len(plants(app, "plants")) == 108


def test_a_plant_that_is_not_there_is_said_in_a_sentence(app, tmp_path):
    upload(app, plot=("plot.zip", zipped(tmp_path, square(0.0008))),
           record=("mites.csv", b"row,plant,date,count\n999,1,2026-11-10,9\n"))  # fmt: skip
    assert not app.exception
    assert "999" in texts_of(app)


def test_what_was_said_of_rows_that_were_drawn_is_told_as_the_commands_tell_it(monkeypatch):
    rows = MultiLineString([LineString([(35.15, y), (35.152, y)]) for y in (30.36, 30.3601)])
    plot = Plot.along("drawn", rows)
    monkeypatch.setattr(plot_files, "row_settings", lambda _: {"row_spacing_m": 7.0})
    files = plot_files.Files(File("a", Path("plot.zip")), None, None, File("b", Path("rows.zip")))
    told = plot_files._said_of_rows(files, plot, "a")
    unused = [one for one in told if "not as was said: row spacing" in one.message.sentence]
    assert [one.asked for one in unused] == [files.rows.asked]
