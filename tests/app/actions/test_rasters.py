"""Rasters of a session: plants that are missing, risk."""

import numpy as np

from fieldmon.monitoring import Season
from tests.app.driving import begun, geotiff, go, metric, plants, press, texts_of


def places(app):
    """Return where plants are, to the centimetre."""
    return np.round(plants(app, "plants").lonlat, 7)


def test_plants_that_a_raster_shows_to_be_missing_are_not_laid(app):
    go(app, "plot")
    every = places(app)
    west, east = every[:, 0].min(), every[:, 0].max()
    low, high = every[:, 1].min(), every[:, 1].max()
    half = np.repeat(np.array([[0.2, 1.5]], np.float32), 50, axis=1).repeat(50, axis=0)
    # the middle half of the plot from west to east, and beyond it to the north and south
    quarter = (east - west) / 4
    data = geotiff(half, (west + quarter, low - 0.001, east - quarter, high + 0.001))
    app.file_uploader(key="missing_plants_file").upload("canopy.tif", data).run()
    left = places(app)
    gone = (every[:, 0] > west + 1.05 * quarter) & (every[:, 0] < west + 1.95 * quarter)
    assert gone.sum() > 500
    assert not set(map(tuple, every[gone])) & set(map(tuple, left))
    stays = (every[:, 0] < west + 0.95 * quarter) | (every[:, 0] > west + 2.05 * quarter)
    assert set(map(tuple, every[stays])) <= set(map(tuple, left))
    assert f"{len(every) - len(left)} of {len(every)} plants are missing" in texts_of(app)
    assert "have no value on the raster and count as there" in texts_of(app)
    app.number_input(key="missing_below").set_value(2.0).run()
    assert len(places(app)) < len(left)
    press(app, "Take it out")
    assert len(places(app)) == len(every)


def test_a_raster_of_risk_changes_the_chances_and_the_season_keeps_it(app, seasons_folder):
    rows = np.repeat(np.linspace(40, 0, 400, dtype=np.float32)[:, None], 400, axis=1)
    data = geotiff(rows)
    before = float(metric(app, "Expected finds"))
    go(app, "plot")
    app.file_uploader(key="risk_file").upload("risk.tif", data).run()
    assert any("nothing says what they mean" in one.value for one in app.warning)
    app.selectbox(key="risk_meaning").set_value("chance").run()
    assert "must hold values in 0..1" in app.error[0].value, "percent were taken for chances"
    app.selectbox(key="risk_meaning").set_value("percent").run()
    assert not app.error
    assert "Risk by percent: 0.1" in texts_of(app)
    go(app, "today")
    assert float(metric(app, "Expected finds")) > before
    begun(app)
    risk = Season(seasons_folder / "Gate 2026.gpkg").risk
    assert risk is not None
    assert 0.1 < np.nanmean(risk) < 0.4
