"""Today: the chance map, the route and the figures of the sample estate."""

from tests.app.driving import heading, layer, map_of, metric


def test_the_first_screen_shows_the_sample_estate_with_a_route(app):
    assert not app.exception
    assert heading(app) == "Gate · 2026-11-16"
    n = len(layer(app, "plants")["data"])
    assert n > 3000
    assert len(layer(app, "route")["data"][0]["path"]) > 100
    assert "hot" in {one["id"] for one in map_of(app)["layers"]}
    assert metric(app, "Plants to inspect").endswith(f"/ {n:,}")
    assert app.get("download_button")
    assert any("finds expected; no route of these hours" in said.value for said in app.caption)


def test_layers_are_switched_off_and_on_while_the_view_stays(app):
    view = map_of(app)["initialViewState"]
    app.pills(key="layers").set_value(["plants", "records"]).run()
    assert layer(app, "route") is None
    assert len(layer(app, "records")["data"]) > 100
    assert map_of(app)["initialViewState"] == view
