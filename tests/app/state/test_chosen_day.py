"""What is known on the chosen day."""

from datetime import date

from tests.app.driving import map_of


def test_records_of_later_days_make_no_hot_spot_yet(app):
    assert "hot" in {one["id"] for one in map_of(app)["layers"]}
    app.date_input[0].set_value(date(2026, 1, 1)).run()
    assert "hot" not in {one["id"] for one in map_of(app)["layers"]}
