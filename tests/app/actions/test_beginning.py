"""A season begins, and is found again."""

from datetime import date, timedelta

import numpy as np
import pytest
from shapely import LineString, MultiLineString, MultiPolygon, box, intersection

from app.words import texts
from fieldmon.infestation.inspections import Inspections
from fieldmon.infestation.records import Records
from fieldmon.monitoring import MonitoringSettings, Season
from fieldmon.plot.block import Block
from fieldmon.plot.field import Field
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from tests.app.driving import (
    begun,
    boxed,
    go,
    headline,
    layer,
    map_of,
    opened,
    plants,
    plot_name,
    press,
    row_box,
    square,
    texts_of,
    upload,
    zipped,
)


def test_a_season_begins_and_is_found_again_by_a_new_session(season):
    app = opened()
    route = layer(app, "route")["data"]
    begun(app)
    assert layer(app, "route")["data"] == route
    assert "has begun" in app.success[0].value
    assert app.selectbox(key="season").value == "Gate 2026"
    assert season().settings.begins == date(2026, 11, 16)
    assert season().messages()
    again = opened("Gate 2026")
    assert plot_name(again) == "Gate"
    assert "on Mon 16 Nov, " in headline(again)
    assert "first day of the season" in texts_of(again)
    assert plants(again).rank.tolist() == plants(app).rank.tolist()
    assert plants(again).lonlat == pytest.approx(plants(app).lonlat, abs=1e-9)
    again.date_input(key="day Gate 2026").set_value(date(2026, 11, 9)).run()
    assert again.date_input(key="day Gate 2026").value == date(2026, 11, 16)
    assert "2026-11-09 was chosen. This is about the nearest" in texts_of(again)


def test_a_season_is_never_begun_over_another_and_its_name_stays_in_the_folder(season_app, season):
    before = season().path.read_bytes()
    season_app.selectbox(key="season").set_value("Sample estate").run()
    for name, says in (("Gate 2026", "new file"), ("../up", "name must be"), ("", "name must be")):
        boxed(season_app.text_input, "season_name").set_value(name)
        press(season_app, "Begin the season")
        assert not season_app.exception
        assert says in season_app.error[0].value
    assert season().path.read_bytes() == before
    assert [p.name for p in season().path.parent.iterdir()] == ["Gate 2026.gpkg"]


def test_a_season_begins_with_what_an_earlier_one_learnt(season_app, season):
    kept = season()

    def begin_after_it(days=1):
        (day,) = [one for one in season_app.date_input if one.key.startswith("day ")]
        day.set_value(kept.settings.begins + timedelta(days=days)).run()
        season_app.selectbox(key="season_earlier").set_value(kept.path.stem)
        boxed(season_app.text_input, "season_name").set_value("Next year")
        press(season_app, "Begin the season")

    season_app.selectbox(key="season").set_value("Sample estate").run()
    begin_after_it()
    assert "nothing was inspected" in season_app.error[0].value
    plants, results = np.arange(3, dtype=np.int32), np.array([1, 0, 0], np.int8)
    kept.record(Inspections.of(plants, results, np.datetime64(kept.settings.begins)), "x")
    begin_after_it(days=0)
    assert "must end before the new one begins" in season_app.error[0].value
    begin_after_it()
    assert not season_app.error
    assert Season(kept.path.parent / "Next year.gpkg").settings.belief.earlier == kept.as_earlier()
    go(season_app, "season")
    assert "Begun with what was learnt on Gate" in texts_of(season_app)


@pytest.mark.parametrize("button", ["Begin the season", "Begin a season"])
def test_a_season_begins_with_finds_that_are_only_flagged_and_a_team(season, button):
    app = opened()
    app.radio(key="begin_finds").set_value(False)
    boxed(app.checkbox, "begin_team").set_value(True).run()
    boxed(app.text_input, "team_name").set_value("Ann")
    press(app, button)
    assert not app.exception
    assert not season().settings.belief.treated
    assert [one.name for one in season().settings.team] == ["Ann", "robot 2"]
    assert app.segmented_control(key="whose_day").options == ["Ann", "robot 2"]


def test_rows_that_nobody_confirmed_are_asked_about_before_a_season_keeps_them(
    app, tmp_path, seasons_folder
):
    one, other = "Begin the season", "Begin a season"
    upload(app, plot=("plot.zip", zipped(tmp_path, square())))
    go(app, "today")
    press(app, one)
    assert not app.exception
    assert not list(seasons_folder.glob("*.gpkg"))
    assert "**Is this right: rows 4 m apart, plants 3 m apart, the rows " in texts_of(app)
    assert "the gate at the nearest row end?" in texts_of(app)
    label = texts.ROW_SPACING.format(unit="m")
    (box,) = [one for one in app.number_input if one.label == label]
    assert box.placeholder == "4"
    box.set_value(2.5).run()
    assert "**Is this right: rows 2.5 m apart, plants 3 m apart, " in texts_of(app)
    press(app, texts.BEGIN_NOT_YET)
    assert "Is this right" not in texts_of(app)
    boxed(app.text_input, "season_name").set_value("../up")
    press(app, other)
    assert "name must be" in app.error[0].value, "a name that cannot be is refused first"
    assert "Is this right" not in texts_of(app)
    boxed(app.text_input, "season_name").set_value("Glass")
    press(app, other)
    # what is typed while it is asked counts, too
    boxed(app.text_input, "season_name").set_value("Glass 1")
    press(app, texts.BEGIN_RIGHT)
    assert not app.exception
    (file,) = seasons_folder.glob("*.gpkg")
    assert file.stem == "Glass 1"
    assert Season(file).plot.grid.row_spacing_m == 2.5
    # they were asked about: they are assumed no more
    begun = Season(file).plot
    assert begun.assumed == ()
    assert Aisles.of(begun.grid).gate_m == pytest.approx(begun.aisles.gate_m, abs=1e-3)
    assert texts.ASSUMED_WHAT["gate"] not in texts_of(go(app, "season"))


def test_while_nothing_is_recorded_another_season_is_begun_with_other_rows(
    app, tmp_path, seasons_folder
):
    upload(app, plot=("plot.zip", zipped(tmp_path, square())))
    go(app, "today")
    press(app, "Begin a season")
    press(app, texts.BEGIN_RIGHT)
    go(app, "plot")
    press(app, texts.ANOTHER)
    assert app.selectbox(key="season").value == "My own files"
    row_box(app, "row_spacing").set_value(2.5).run()
    go(app, "today")
    assert "Is this right" not in texts_of(app)
    press(app, "Begin a season")
    press(app, texts.BEGIN_RIGHT)
    assert not app.exception
    first, second = sorted(seasons_folder.glob("*.gpkg"), key=lambda file: len(file.stem))
    assert second.stem == f"{first.stem} (2)"
    assert [Season(file).plot.grid.row_spacing_m for file in (first, second)] == [4.0, 2.5]
    kept = Season(second)
    kept.record(Inspections.of(np.array([0]), np.array([0]), np.datetime64(kept.settings.begins)))
    assert texts.ANOTHER not in {one.label for one in go(app, "plot").button}


def test_another_season_of_one_opened_by_its_address_has_its_measured_plants_and_their_names(
    season_named, seasons_folder
):
    app = go(opened(season_named.path.stem), "plot")
    press(app, texts.ANOTHER)
    assert not app.exception
    assert not app.error
    begun(app, "Own again")
    before, after = season_named.plot, Season(seasons_folder / "Own again.gpkg").plot
    assert np.array_equal(before.field.plants, after.field.plants)
    assert np.allclose(before.grid.lonlat(), after.grid.lonlat(), rtol=0.0, atol=1e-8)
    assert list(before.grid.line_signs.values()) == list(after.grid.line_signs.values())
    assert np.array_equal(before.field.plant_names, after.field.plant_names)


AREA = MultiPolygon([box(35.1500, 30.3600, 35.1506, 30.3605)])
WEST, EAST = box(35.1500, 30.3600, 35.1503, 30.3605), box(35.1503, 30.3600, 35.1506, 30.3605)
BENT = LineString([(35.15005, 30.3601), (35.1503, 30.36025), (35.15055, 30.36015)])
SCATTERED = np.random.default_rng(1).uniform([35.15005, 30.36005], [35.15055, 30.36045], (40, 2))
PLANTED = {
    "blocks": (
        {"blocks": (Block("west", WEST, 20.0, 3.0, 2.0), Block("east", EAST))},
        {"row_spacing_m": 5.0, "headland_m": 6.5},
    ),
    "one bent row": ({"row_lines": MultiLineString([BENT])}, {"row_spacing_m": 3.5}),
    "a bent row a block": (
        {"blocks": (Block("west", WEST), Block("east", EAST, 90.0)),
         "row_lines": MultiLineString([intersection(BENT, WEST)])},
        {},
    ),
    "no rows": ({"plants": SCATTERED, "in_rows": False}, {}),
    "by hand": (
        {}, {"row_bearing_deg": 200.0, "row_spacing_m": 2.5, "plant_spacing_m": 1.5, "faces": 2,
             "half_canopy_m": 0.4, "headland_m": 2.0},
    ),
}  # fmt: skip


@pytest.mark.parametrize("kind", PLANTED)
def test_another_season_of_one_opened_by_its_address_is_laid_as_that_one(kind, seasons_folder):
    drawn, planting = PLANTED[kind]
    before = Plot.of(Field("Hill", AREA, **drawn), Planting(**planting))
    settings = MonitoringSettings(date(2026, 11, 16), robot=Robot(hours=1.0))
    Season.create(seasons_folder / "Hill 2026.gpkg", before, Records.none(), settings)
    app = go(opened("Hill 2026"), "plot")
    press(app, texts.ANOTHER)
    assert not app.exception
    assert not app.error
    begun(app, "Hill again")
    after = Season(seasons_folder / "Hill again.gpkg").plot
    assert np.allclose(before.grid.lonlat(), after.grid.lonlat(), rtol=0.0, atol=1e-8)
    for one in ("row_start", "twin", "block"):
        assert np.array_equal(getattr(before.grid, one), getattr(after.grid, one)), one
    for one in ("in_rows", "half_canopy_m", "row_spacing_m", "plant_spacing_m"):
        assert getattr(after.grid, one) == pytest.approx(getattr(before.grid, one)), one
    assert [one.name for one in after.field.blocks] == [one.name for one in before.field.blocks]
    assert after.headland_m == before.headland_m


def test_the_gate_is_set_on_the_map_before_a_season_begins(app, tmp_path):
    upload(app, plot=("plot.zip", zipped(tmp_path, square())))
    go(app, "today")
    press(app, "Begin a season")
    app.button(key="begin_gate").click()
    app.run()
    go(app, "plot")
    assert map_of(app)["draw"]["id"] == "gate"


@pytest.mark.parametrize("said", ["file", "hand"])
def test_rows_that_a_file_or_a_person_said_begin_with_one_click(app, seasons_folder, said):
    here = square(name='a/"b"')
    if said == "file":
        here = here.assign(row_spacing=3.0, plant_spacing=2.0, bearing=10.0)
    upload(app, plot=("plot.geojson", here.to_json().encode()))
    if said == "hand":
        for name, value in (("row_bearing", 10.0), ("row_spacing", 3.0), ("plant_spacing", 2.0)):
            row_box(app, name).set_value(value).run()
    go(app, "today")
    press(app, "Begin a season")
    assert not app.exception
    (path,) = seasons_folder.glob("*.gpkg")
    assert path.stem.startswith("a-b 2"), "proposed without signs that no file's name has"
    assert Season(path).plot.field.name == 'a/"b"'
    assert "of one plot" not in app.success[0].value
    if said == "file":  # brought a second time
        upload(app, plot=("again.geojson", here.to_json().encode()))
        press(go(app, "today"), "Begin a season")
        assert "are 2 seasons of one plot: each counts" in app.success[0].value


def test_records_left_out_are_said_before_a_season_begins_and_when_it_begins(app):
    """The sample's records go up to its last day: begun earlier, the later ones are left out."""
    app.date_input(key="day Sample estate").set_value(date(2026, 11, 9)).run()
    assert "of a later day and are left out" in texts_of(go(app, "today"))
    begun(app)
    assert "of a later day and are left out" in app.success[0].value
    # on another day it is still those of the day on which the season began
    app.date_input(key="day Gate 2026").set_value(date(2026, 11, 16)).run()
    assert "of a later day" not in texts_of(go(app, "today"))
    said = texts_of(go(app, "plot"))
    assert "as known on Mon 9 Nov, when the season began" in said
    assert "of a later day and are left out" in said


def test_another_plot_is_proposed_a_name_of_its_own(app):
    boxed(app.text_input, "season_name").set_value("Mine").run()
    which = next(box for box in app.selectbox if box.label == texts.WHICH_PLOT)
    which.set_value(1).run()
    assert boxed(app.text_input, "season_name").value == f"{plot_name(app)} 2026" != "Gate 2026"
