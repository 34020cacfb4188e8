"""A season's file is backed up, named anew and taken off the list."""

from app.actions import keeping
from app.state import seasons_folder as folder
from app.words import texts
from fieldmon.monitoring import Season
from fieldmon.monitoring.phones import scouts
from tests.app.chosen import in_season
from tests.app.driving import go, tap, texts_of
from tests.monitoring.seasons import a_season


def test_a_backup_is_the_whole_season_as_it_is_now(tmp_path):
    season = a_season(tmp_path / "season.gpkg")
    copy = tmp_path / "copy.gpkg"
    copy.write_bytes(keeping.backed_up(in_season(season)))
    assert Season(copy).settings == season.settings
    assert Season(copy).revision == season.revision


def test_a_season_is_named_anew_and_stays_open(season_app, season):
    go(season_app, "season")
    tap_refused(season_app, "rename", "is called")
    assert texts.RENAME_CODES not in texts_of(season_app)
    scouts.let_in(season(), "Dana")
    season_app.run()
    assert texts.RENAME_CODES in texts_of(season_app)
    box(season_app).set_value("North 2026").run()
    tap(season_app, "rename")
    assert folder.names() == ["North 2026"]
    assert season_app.query_params["season"] in ("North 2026", ["North 2026"])
    assert "is called" in season_app.success[0].value
    assert box(season_app).value == "North 2026"


def test_a_season_goes_off_the_list_once_it_is_asked_and_answered(season_app, season):
    go(season_app, "season")
    tap(season_app, "remove")
    assert folder.names() == ["Gate 2026"]
    tap(season_app, "remove_no")
    assert not [one for one in season_app.button if one.key == "remove_yes"]
    data = season().path.read_bytes()
    tap(season_app, "remove")
    tap(season_app, "remove_yes")
    assert folder.names() == []
    assert (folder.folder() / folder.REMOVED / "Gate 2026.gpkg").read_bytes() == data
    assert "is off the list" in season_app.success[0].value
    assert season_app.selectbox(key="season").value == "Sample estate"


def box(app):
    return next(one for one in app.text_input if one.label == texts.RENAME_TO)


def tap_refused(app, key, said):
    app.button(key=key).click().run()
    assert said in app.error[0].value
