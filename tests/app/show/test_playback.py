"""A day is played as it is planned, or as it was worked."""

from datetime import date

import numpy as np
import pytest

from fieldmon.infestation.inspections import Inspections
from fieldmon.monitoring import worked_route
from tests.app.driving import go, layer


def test_the_path_grows_as_the_day_is_played(app):
    go(app, "map")
    clock = "clock 2026-11-16"
    lengths = []
    for minute in (30, 200, 500):
        app.slider(key=clock).set_value(minute).run()
        lengths.append(len(layer(app, "trail")["data"][0]["path"]))
    assert lengths == sorted(set(lengths))
    app.button(key="play").click().run()
    assert not app.exception
    assert app.slider(key=clock).value >= 500


def test_a_day_that_was_worked_is_played_as_it_was_worked(season_app, season):
    plants = np.array([900, 5, 200])
    for on, at_s in (("2026-11-16", [25_200.0, 21_660.0, 28_800.0]), ("2026-11-17", [np.nan] * 3)):
        season().record(
            Inspections.of(plants, np.zeros(3, np.int8), np.datetime64(on), second=np.array(at_s)),
            on,
        )
    noted, driven = (worked_route(season(), date(2026, 11, day)) for day in (16, 17))
    assert noted.plant.tolist() == [5, 900, 200], "in the order of the times noted"
    assert noted.leave_s.tolist() == [60.0, 3600.0, 7200.0]
    assert noted.line_m[noted.line_stop] == pytest.approx(noted.aisles.stop_m[noted.plant])
    assert driven.plant.tolist() == plants.tolist()
    gaps = np.diff(driven.leave_s, prepend=0.0)
    assert (gaps > season().settings.robot.visit_s).all()
    go(season_app, "map")
    season_app.select_slider[0].set_value("2026-11-16").run()
    path = layer(season_app, "route")["data"][0]["path"]
    assert np.array(path) == pytest.approx(noted.line_lonlat(), abs=1e-7)
