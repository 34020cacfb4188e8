"""A season comes back: from a backup, or from those taken off the list."""

from app.state import seasons_folder as folder
from app.words import texts
from fieldmon.monitoring import Season
from tests.app.driving import go, plot_name, tap, texts_of, upload


def test_a_backup_dropped_where_a_plot_goes_is_a_season_again_and_no_plot(season_app, season):
    upload(season_app, plot=("Gate 2026.gpkg", season().path.read_bytes()))
    assert not season_app.exception
    assert "is the file of a season" in texts_of(season_app)
    assert "Which of these is your plot" not in texts_of(season_app)
    tap(season_app, "take_in")
    assert folder.names() == ["Gate 2026", "Gate 2026 (2)"]
    assert season_app.selectbox(key="season").value == "Gate 2026 (2)"
    assert plot_name(go(season_app, "today")) == "Gate"
    assert Season(folder.path_of("Gate 2026 (2)")).revision == season().revision


def test_a_season_taken_off_the_list_is_brought_back_there(season_app):
    go(season_app, "season")
    tap(season_app, "remove")
    tap(season_app, "remove_yes")
    season_app.selectbox(key="season").set_value("My own files").run()
    assert texts.REMOVED_ONES in [one.label for one in go(season_app, "plot").expander]
    tap(season_app, "bring_back")
    assert (folder.names(), folder.removed()) == (["Gate 2026"], [])
    assert season_app.selectbox(key="season").value == "Gate 2026"
