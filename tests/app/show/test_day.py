"""A day in figures and words."""

import re

from tests.app.driving import go, row_box, tap, texts_of


def test_too_short_a_day_is_said_in_a_sentence(app):
    go(app, "plot")
    row_box(app, "headland").set_value(40.0).run()
    app.slider(key="hours Robot").set_value(0.5).run()
    assert not app.exception


def test_today_says_why_it_goes_where_it_goes(season_app):
    assert "never inspected yet" in texts_of(season_app)
    go(season_app, "scout")
    place = season_app.markdown[0].value.lower()
    tap(season_app, "scout_found")
    go(season_app, "today")
    why = next(m.value for m in season_app.markdown if "around today's find" in m.value)
    row, plant = (int(n) for n in re.findall(r"find in row (\d+), plant (\d+)", why)[0])
    assert f"row {row} · plant {plant}" in place
