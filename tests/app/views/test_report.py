"""The report on its page."""

from tests.app.driving import go, texts_of


def test_the_report_holds_map_figures_settings_and_stops(app):
    go(app, "report")
    assert not app.exception
    assert "Save as PDF" in texts_of(app)
    assert app.get("download_button")
