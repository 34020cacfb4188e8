"""The report on its page."""

from app.words import texts
from tests.app.driving import begun, go


def downloads(app):
    return [one.proto.label for one in app.get("download_button")]


def labels(widgets):
    return [widget.label for widget in widgets]


def test_a_day_is_handed_out_as_pdf_first_and_as_html(app):
    go(app, "report")
    assert not app.exception
    assert downloads(app) == [texts.REPORT_PDF, texts.REPORT_HTML]
    assert texts.REPORT_ABOUT not in labels(app.radio), "without a season there is but the day"


def test_in_a_season_the_season_is_handed_out_too_on_either_paper(app):
    begun(app)
    go(app, "report")
    (about,) = [one for one in app.radio if one.label == texts.REPORT_ABOUT]
    about.set_value("season").run()
    (paper,) = [one for one in app.selectbox if one.label == texts.REPORT_PAPER]
    assert paper.options == ["A4", "Letter"]
    paper.set_value("letter").run()
    assert not app.exception
    assert downloads(app) == [texts.REPORT_PDF, texts.REPORT_HTML]


def test_the_record_for_a_certifier_is_handed_out_in_a_season(app):
    begun(app)
    go(app, "report")
    (about,) = [one for one in app.radio if one.label == texts.REPORT_ABOUT]
    about.set_value("certification").run()
    assert not app.exception
    assert downloads(app) == [texts.REPORT_PDF, texts.REPORT_HTML]
