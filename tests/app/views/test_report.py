"""The report on its page."""

from app.words import texts
from tests.app.driving import go


def downloads(app):
    return [one.proto.label for one in app.get("download_button")]


def labels(widgets):
    return [widget.label for widget in widgets]


def test_a_day_is_handed_out_as_pdf_first_and_as_html(app):
    go(app, "report")
    assert not app.exception
    assert downloads(app) == [texts.REPORT_PDF, texts.REPORT_HTML]
    assert texts.REPORT_ABOUT not in labels(app.radio), "without a season there is but the day"


def test_in_a_season_that_and_a_certifier_s_record_are_handed_out_too_on_either_paper(season_app):
    go(season_app, "report")
    for about in ("season", "certification"):
        (box,) = [one for one in season_app.radio if one.label == texts.REPORT_ABOUT]
        box.set_value(about).run()
        assert not season_app.exception
        assert downloads(season_app) == [texts.REPORT_PDF, texts.REPORT_HTML]
        (paper,) = [one for one in season_app.selectbox if one.label == texts.REPORT_PAPER]
        assert paper.options == ["A4", "Letter"]
        paper.set_value("letter").run()
        assert not season_app.exception
        assert downloads(season_app) == [texts.REPORT_PDF, texts.REPORT_HTML]
